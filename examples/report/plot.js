// What report.js draws with: the marks that it names, so that the bundle holds no others.
export { areaY, axisX, axisY, dot, gridX, gridY, line, plot, rect, ruleX, ruleY, text, tip, pointer, legend } from "@observablehq/plot";
