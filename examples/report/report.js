// Draws the pages of gonio report and of --report of other commands. Text of files becomes text nodes, never HTML.
// check.js, design.js and fit.js have the parts of their own pages, readings.js and scans.js the parts of fits.

// ---- numbers --------------------------------------------------------------------------------------
const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
const digits = (value) => (value === null || !Number.isFinite(value) ? "-" : String(Number(value.toPrecision(3))));
const percent = (share) => !Number.isFinite(share) ? "no limit" : (share >= 9.95 ? `a factor of ${digits(share + 1)}` : `${Number((100 * share).toPrecision(2))} %`);
const angle = (value) => `${Number(value.toFixed(1))}\u00b0`;
const channels = (value) => value.map(digits).join(", ");
const is_grey = (value) => value[0] === value[1] && value[1] === value[2];

const add = (...children) => page.append(...children);

// Gives a chart a description for screen readers.
function described(chart, description) {
  const image = chart.tagName === "svg" ? chart : chart.querySelector("svg:last-of-type");
  image.setAttribute("role", "img");
  image.setAttribute("aria-label", description);
  without_names(image);
  return chart;
}
// Returns charts with a caption and with a table of their values, for those who cannot see the charts.
function captioned(charts, caption, head, rows) {
  return element("figure", {}, charts, element("figcaption", {}, caption),
    element("details", {}, element("summary", {}, "Values"), element("div", { className: "scroll" }, table(head, rows))));
}
const figure = (chart, description, ...rest) => captioned(described(chart, description), ...rest);

const by_number = new Map((data.samples ?? []).map((each) => [each.sample, each]));
const is_off = (each) => each.disagrees;
const of_the_first = () => (others.length ? `Of ${measurements[0].name} alone. ` : "");
const off = (data.samples ?? []).filter(is_off);
const where = (each) => `theta_i ${angle(each.theta_i)}, theta_o ${angle(each.theta_o)}, half angle ${angle(each.theta_h)}`;
const known_suffix = (each) => (each.known_to === undefined ? "" : `, ${known_to(each.known_to)}`);
function told(each) {
  const lines = [`sample ${each.sample}: ${where(each)}`, `measured ${channels(each.measured)}`,
    `fit ${channels(each.fit)}${known_suffix(each)}`];
  if (each.others) lines.push(`the others say ${channels(each.others)}`, `off by ${digits(Math.sqrt(each.disagreement))} deviations`);
  if (each.disagrees) lines.push("disagrees with the others");
  return lines.join("\n");
}
// Draws samples as dots, and those that disagree as crosses, with numbers if there are at most four. Samples and
// `others` have tips.
function samples_as_marks(samples, x, y, others = []) {
  const wrong = samples.filter(is_off);
  return [
    Plot.dot(samples.filter((each) => !is_off(each)), { x, y, r: 3.5, fill: "var(--ink)", stroke: "var(--paper)" }),
    Plot.dot(wrong, { x, y, r: wrong.length > 12 ? 4 : 6, symbol: "times", stroke: "var(--wrong)", strokeWidth: 2.5 }),
    Plot.text(wrong.length > 4 ? [] : wrong, { x, y, text: (each) => String(each.sample), dx: 8, dy: -8, textAnchor: "start",
      fill: "var(--wrong)", fontWeight: 700, stroke: "var(--paper)", strokeWidth: 3 }),
    Plot.tip([...samples, ...others], Plot.pointer({ x, y, title: (each) => each.tip ?? told(each) })),
  ];
}

// ---- the answer ------------------------------------------------------------------------------------------------
function verdict() {
  const { details, count } = data;
  const box = element("div", { className: off.length || details.down_weighted > 0 ? "disagree" : "agree" });
  const contradicted = details.left_out || [], share = details.down_weighted || 0;
  const repeated = data.warnings.some((each) => each.includes("have the same directions"));
  if (contradicted.length === 0 && share === 0) {
    box.append(paragraph(count === 1 ? "One sample: there is no other that could disagree."
      : repeated ? "Samples of the same directions contradict each other; which of them is wrong the others do not say."
      : `None of the ${count} samples disagrees with the others.`));
    return box;
  }
  const number = Math.round(share * count);
  box.append(paragraph(`${number} of ${count} samples ${number === 1 ? "disagrees" : "disagree"} with the others and ` +
    `${number === 1 ? "counts" : "count"} less than half` + (contradicted.length < number ? "; the worst:" : ":")));
  for (const each of contradicted) {
    const sample = by_number.get(each.sample);
    box.append(paragraph(`\u2715 Sample ${each.sample} (${sample ? where(sample) : ""}): measured ${channels(each.measured)}, ` +
      `the others say ${channels(each.others)} (red, green, blue, sr\u207b\u00b9).`));
  }
  return box;
}

function answer() {
  const { details, count } = data;
  const words = element("div", {},
    paragraph(`Half of all directions are ${known_to(details.known_to)}.`, "headline"),
    paragraph(`Half of the directions more than 80\u00b0 from the normal are ${known_to(details.known_to_beyond_80_degrees)}; the highlight is ` +
      (details.highlight_known_to_factor > 100 ? "not known." : `known to a factor of ${digits(details.highlight_known_to_factor)} (95 of 100 cases).`)),
    verdict(),
    paragraph(`From ${count} ${count === 1 ? "sample" : "samples"}. \u201cKnown to 6 %\u201d: in 68 of 100 cases the true value is ` +
      "within 6 % of the fit, for materials like those of the prior. Gloss, haze and colours are as certain as the fit in the direction of the " +
      "receptor\u2019s centre; the certainty of reflectance assumes that all directions are off together. \u201cNot known\u201d is a factor of 3 or more.", "soft"));
  const repeats = /^sample \d+ disagrees/; // the verdict has these
  for (const sentence of data.warnings.filter((each) => !repeats.test(each))) words.append(paragraph("Note: " + sentence, "soft"));
  add(element("h1", {}, data.name), sphere_and_readings("A sphere of the reconstructed material under two lights"), words);
}

// ---- where ----------------------------------------------------------------------------------------------------
// The axes of maps over half and difference angle. theta_h has the scale of its square root, which widens the
// highlight.
const angle_axes = {
  width: 1040, height: 430, marginLeft: 50, marginBottom: 42,
  x: { type: "sqrt", domain: [0, 90], ticks: [0, 1, 2, 5, 10, 20, 30, 45, 60, 75, 90], label: "half angle theta_h, degrees from the normal" },
  y: { domain: [0, 90], ticks: [0, 15, 30, 45, 60, 75, 90], label: "difference angle theta_d, degrees" },
};

// Returns the fields of a map of uncertainty, each with its number.
function fields_of_map(map) {
  const cells = map.map((each) => ({ ...each, percent: 100 * each.known_to }));
  return { cells, scale: { type: "log", domain: [2, 100], clamp: true, range: ["#f3ecd2", "#123a63"], interpolate: "rgb" }, marks: [
    Plot.rect(cells, { x1: (each) => each.theta_h[0], x2: (each) => each.theta_h[1], y1: (each) => each.theta_d[0], y2: (each) => each.theta_d[1],
      fill: "percent", inset: 0.5 }),
    Plot.text(cells, { x: (each) => (0.5 * (Math.sqrt(each.theta_h[0]) + Math.sqrt(each.theta_h[1]))) ** 2,
      y: (each) => 0.5 * (each.theta_d[0] + each.theta_d[1]), text: (each) => (each.percent >= 999.5 ? ">999" : each.percent.toFixed(0)),
      fill: (each) => (each.percent > 18 ? "#ffffff" : "#1b1d21"), fontSize: 11 }),
  ] };
}

function uncertainty_map() {
  add(element("h2", {}, "Where was measured, and where the fit is unsure"),
    paragraph(`${of_the_first()}The number in each field: to how many percent directions are known, the median over the third angle. Dots: samples; crosses: those that disagree. ` +
      "Left: the highlight; top: grazing light and viewer."));
  const { cells, scale, marks } = fields_of_map(data.map), many = data.samples.length > 200;
  const chart = Plot.plot({
    ...angle_axes, color: scale,
    marks: [
      ...marks,
      Plot.dot(data.samples.filter((each) => !is_off(each)), { x: "theta_h", y: "theta_d", r: many ? 2 : 4, fill: "#ffffff", stroke: "#000000", strokeWidth: many ? 1 : 1.5 }),
      Plot.dot(off, { x: "theta_h", y: "theta_d", r: many ? 4 : 7, symbol: "times", stroke: "#ffffff", strokeWidth: 5 }),
      Plot.dot(off, { x: "theta_h", y: "theta_d", r: many ? 4 : 7, symbol: "times", stroke: "#c2410c", strokeWidth: 2.5 }),
      Plot.tip(data.samples, Plot.pointer({ x: "theta_h", y: "theta_d", title: told })),
    ],
  });
  const worst = cells.reduce((a, b) => (a.percent > b.percent ? a : b)), best = cells.reduce((a, b) => (a.percent < b.percent ? a : b));
  const region = (each) => `theta_h ${angle(each.theta_h[0])} to ${angle(each.theta_h[1])}, theta_d ${angle(each.theta_d[0])} to ${angle(each.theta_d[1])}`;
  add(figure(chart, `Map of uncertainty over half and difference angle: best known at ${region(best)}, to ${digits(best.percent)} %; worst at ${region(worst)}, to ${digits(worst.percent)} %`,
    `Best known: ${region(best)}, to ${percent(best.known_to)}. Least: ${region(worst)}, to ${percent(worst.known_to)}. gonio design --given says which directions to measure next.`,
    ["theta_h", "theta_d", "known to"],
    cells.map((each) => [`${angle(each.theta_h[0])} to ${angle(each.theta_h[1])}`, `${angle(each.theta_d[0])} to ${angle(each.theta_d[1])}`, percent(each.known_to)])));
}

// ---- residuals -------------------------------------------------------------------------------------------------
function residuals() {
  const has_others = data.samples.some((each) => each.others);
  const residual = (each) => has_others
    ? Math.sign(luminance(each.measured) - luminance(each.others)) * Math.sqrt(each.disagreement)
    : 100 * (luminance(each.measured) / luminance(each.fit) - 1);
  const shown = data.samples.map((each) => ({ ...each, residual: residual(each), grazing: Math.max(each.theta_i, each.theta_o) }))
    .filter((each) => Number.isFinite(each.residual));
  add(element("h2", {}, "Residuals by direction"),
    paragraph(of_the_first() + (has_others ? "By how many deviations each sample is above or below its prediction from all others. 95 of 100 should be in the band."
      : `By how many percent each ${data.of_table ? "value of the table in these planes" : "sample"} is above or below the fit` +
        (data.samples.length < data.count ? `; ${data.samples.length} of ${data.count} samples: 1000 at random${data.kind === "fit" ? "." : ", and the worst."}` : "."))));
  residual_charts(shown, { title: "Residuals", unit: has_others ? "deviations" : "percent", has_band: has_others, tip: told,
    head: ["measured", has_others ? "the others" : "fit"], values: (each) => [each.measured, has_others ? each.others : each.fit] });
}

// Draws residuals against the half angle and against the larger angle from the normal: `residual` and `grazing` of each
// of `shown`. The table has `values(each)` below `head`.
function residual_charts(shown, { title, unit, has_band, tip, head, values }) {
  const largest = Math.max(3, ...shown.map((each) => Math.abs(each.residual)));
  const tipped = shown.map((each) => ({ ...each, tip: tip(each) }));
  const chart = (x, label) => Plot.plot({
    width: 520, height: 280, marginLeft: 52, marginBottom: 40, x: { domain: [0, 90], label, grid: false },
    y: { type: largest > 10 ? "symlog" : "linear", domain: [-largest * 1.1, largest * 1.1], label: unit, grid: true,
      ticks: largest > 10 ? [-1000, -100, -30, -10, -3, -1, 0, 1, 3, 10, 30, 100, 1000].filter((tick) => Math.abs(tick) <= largest * 1.1) : undefined },
    marks: [
      ...(has_band ? [Plot.rect([0], { x1: 0, x2: 90, y1: -2, y2: 2, fill: "var(--fit)", fillOpacity: 0.14 })] : []),
      Plot.ruleY([0], { stroke: "var(--soft)" }),
      ...samples_as_marks(tipped, x, "residual"),
    ],
  });
  const worst = shown.length ? shown.reduce((a, b) => (Math.abs(a.residual) > Math.abs(b.residual) ? a : b)) : null;
  const summary = worst ? `largest for sample ${worst.sample}, ${digits(worst.residual)}` : "none";
  const one = (x, label, name) => figure(chart(x, label), `${title} against ${name}: ${summary}`, `Against ${name}`,
    ["sample", name, ...head, unit],
    shown.map((each) => [String(each.sample), angle(each[x]), ...values(each).map(channels), digits(each.residual)]));
  add(element("div", { className: "charts" },
    one("theta_h", "half angle theta_h, degrees", "the half angle (0 is the highlight)"),
    one("grazing", "larger of theta_i and theta_o, degrees", "the larger angle from the normal")));
}

// ---- albedo ----------------------------------------------------------------------------------------------------
function albedo() {
  add(element("h2", {}, "Albedo by angle"),
    paragraph("What share of the light is reflected in all directions together." + (data.kind === "fit" ? " Thin line: the luminance."
      : " Band, and thin line: the luminance, and what it would be if all directions were off together.") +
      (others.length ? " The others: their luminance." : "")), ...key_of_measurements());
  const grey = data.albedo.every((each) => is_grey(each.albedo)), names = grey ? ["grey"] : ["red", "green", "blue"];
  const dashes = ["none", "8 3", "2 3"], last = data.albedo[data.albedo.length - 1];
  const bands = data.albedo.filter((each) => each.known_to !== null);
  const beside = measurements.slice(1), highest = Math.max(...[data, ...beside].flatMap((each) => each.albedo.flatMap(({ albedo }) => albedo)));
  const top = Math.max(1.05, Math.min(1.1 * highest, 20));
  // Put the lines' names at their ends, without overlaps.
  const ends = names.map((name, c) => ({ name, y: last.albedo[c] })).sort((a, b) => a.y - b.y);
  for (let i = 1; i < ends.length; ++i) ends[i].y = Math.max(ends[i].y, ends[i - 1].y + 0.06 * top);
  const chart = Plot.plot({
    width: 1040, height: 300, marginLeft: 50, marginRight: 60, marginBottom: 40,
    x: { domain: [0, 90], label: "angle of the light from the normal, degrees", ticks: [0, 15, 30, 45, 60, 75, 90] },
    y: { domain: [0, top], label: "albedo", grid: true, clamp: true },
    marks: [
      Plot.areaY(bands, { x: "theta_i", y1: (each) => luminance(each.albedo) / (1 + each.known_to),
        y2: (each) => luminance(each.albedo) * (1 + each.known_to), fill: "var(--fit)", fillOpacity: 0.18, clip: true }),
      ...(grey ? [] : [Plot.line(data.albedo, { x: "theta_i", y: (each) => luminance(each.albedo), stroke: "var(--soft)", strokeWidth: 1 })]),
      Plot.text(ends, { x: last.theta_i, y: "y", text: "name", dx: 8, textAnchor: "start" }),
      Plot.ruleY([1], { stroke: "var(--soft)", strokeDasharray: "6 4" }),
      Plot.text([0], { x: 1, y: 1, text: () => "all light", dy: -8, textAnchor: "start", fill: "var(--soft)" }),
      ...names.map((name, c) => Plot.line(data.albedo, { x: "theta_i", y: (each) => each.albedo[c], stroke: grey ? "var(--ink)" : `var(--${name})`,
        strokeWidth: 2, strokeDasharray: dashes[c] })),
      ...beside.map((other) => Plot.line(other.albedo, { x: "theta_i", y: (each) => luminance(each.albedo), stroke: other.look.stroke, strokeWidth: 2,
        strokeDasharray: other.look.dashes })),
      ...beside.map((other) => Plot.dot(other.albedo, { x: "theta_i", y: (each) => luminance(each.albedo), r: 4, symbol: other.look.symbol, fill: other.look.dot,
        stroke: "var(--paper)" })),
      Plot.tip(data.albedo, Plot.pointer({ x: "theta_i", y: (each) => luminance(each.albedo),
        title: (each) => `light at ${angle(each.theta_i)}\n${names.map((name, c) => `${name} ${digits(each.albedo[c])}`).join("\n")}` })),
    ],
  });
  const key = names.length === 1 ? "" : " Red: solid; green: dashes; blue: dots.";
  add(figure(chart, `Albedo by angle: ${channels(data.albedo[0].albedo)} at 0 degrees, ${channels(last.albedo)} at ${angle(last.theta_i)}`,
    `At normal incidence ${channels(data.albedo[0].albedo)} (red, green, blue).` + key, ["light", ...names, ...(bands.length ? ["known to"] : []), ...beside.map((each) => each.name)],
    data.albedo.map((each, i) => [angle(each.theta_i), ...names.map((_, c) => digits(each.albedo[c])), ...(bands.length ? [each.known_to === null ? "-" : percent(each.known_to)] : []),
      ...beside.map((other) => digits(luminance(other.albedo[i].albedo)))])));
}

// ---- what was done ---------------------------------------------------------------------------------------------
function record() {
  const rows = data.record.map(([name, text]) => element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, text)));
  add(element("h2", {}, "What was done"), element("table", { className: "record" }, element("tbody", {}, ...rows)));
}

const pages = {
  reconstruct: [answer, show_viewer, scans, uncertainty_map, residuals, albedo, record],
  check: [check_answer, check_differences, check_places, record],
  fit: [fit_answer, scans, residuals, albedo, record],
  design: [design_answer, design_map, design_table, record],
};
for (const part of pages[data.kind]) part();
