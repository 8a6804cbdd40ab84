// The functions of Observable Plot that report.js uses: the bundle contains no others.
export { areaY, axisX, axisY, dot, gridX, gridY, line, plot, rect, ruleX, ruleY, text, tip, pointer, legend } from "@observablehq/plot";
