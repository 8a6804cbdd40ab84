// The readings of a gloss meter, an integrating sphere and a multi-angle instrument, and the lines and dots of a page's
// measurements.

// ---- measurements ----------------------------------------------------------------------------------------------
// The page's own measurement and those given beside it, each with its own line and dots.
const others = data.others ?? [];
const looks = [
  { stroke: "var(--fit)", dot: "var(--ink)", dashes: "none", symbol: "circle" },
  { stroke: "var(--other-1)", dot: "var(--other-1)", dashes: "8 3", symbol: "triangle" },
  { stroke: "var(--other-2)", dot: "var(--other-2)", dashes: "3 2", symbol: "square" },
  { stroke: "var(--other-3)", dot: "var(--other-3)", dashes: "9 3 2 3", symbol: "diamond" },
  { stroke: "var(--other-4)", dot: "var(--other-4)", dashes: "14 4", symbol: "star" },
  { stroke: "var(--other-5)", dot: "var(--other-5)", dashes: "1 3", symbol: "wye" },
];
const measurements = [{ ...data, name: data.subject ?? data.name }, ...others].map((each, i) => ({ ...each, look: looks[i] }));

// Returns the name of a measurement after a piece of its line with a dot.
function named_line({ name, look }) {
  const image = Plot.plot({ width: 38, height: 12, margin: 0, axis: null, x: { domain: [0, 2] }, y: { domain: [-1, 1] }, marks: [
    Plot.line([[0, 0], [2, 0]], { stroke: look.stroke, strokeWidth: 2, strokeDasharray: look.dashes }),
    Plot.dot([[1, 0]], { r: 4, symbol: look.symbol, fill: look.dot, stroke: "var(--paper)" })] });
  image.setAttribute("aria-hidden", "true");
  return element("span", { className: "measurement" }, without_names(image), element("span", {}, name));
}
const key_of_measurements = () => (others.length ? [element("p", { className: "key" }, ...measurements.map(named_line))] : []);

// ---- readings --------------------------------------------------------------------------------------------------
const largest_known = 2; // relative deviation, a factor of 3, from which on a reading is not known

const one_digit = (value) => value.toFixed(1).replace(/^-0\.0$/, "0.0");
const share = (value) => `${digits(100 * value)} %`;

// Returns rows of a name, a value as text, and its relative deviation, if known.
function reading_rows({ gloss, haze_20, luminous_reflectance_8, luminous_reflectance_8_specular_excluded, reflectance_8, colours, known_to }) {
  const known = known_to ?? {}, grey = is_grey(reflectance_8);
  return [
    ...Object.keys(gloss).map((angle) => [`Gloss, ${angle}\u00b0`, digits(gloss[angle]), known.gloss?.[angle]]),
    ["Haze, 20\u00b0", digits(haze_20), known.haze_20],
    ["Reflectance, 8\u00b0, specular included", share(luminous_reflectance_8), known.reflectance_8],
    ["Reflectance, 8\u00b0, specular excluded", share(luminous_reflectance_8_specular_excluded), known.reflectance_8_specular_excluded],
    ...colours.map(({ aspecular, L, a, b }, i) => [`${grey ? "L*" : "L*a*b*"}, ${aspecular}\u00b0 aspecular`,
      (grey ? [L] : [L, a, b]).map(one_digit).join(", "), known.colours?.[i]]),
  ];
}

const known_to = (share) => (Number.isFinite(share) && share < largest_known ? `known to ${percent(share)}` : "not known");
const reading_of = ([, value, known]) => (known >= largest_known ? "not known" : value);
const certainty_of = ([, , known]) => (known === undefined ? "" : known === null ? "-" : percent(known));

// Returns a table of readings: for one measurement, a column of values and one of certainties; for several, a column
// with both for each.
function readings_table() {
  const all = measurements.map((each) => reading_rows(each.readings)), has_certainty = all[0].some(([, , known]) => known !== undefined);
  const both = (row) => element("span", {}, reading_of(row), " ", element("span", { className: "certainty" }, `(${certainty_of(row)})`));
  const made = others.length
    ? table(["reading (known to)", ...measurements.map(named_line)], [
      ...all[0].map(([name], row) => [name, ...all.map((rows) => both(rows[row]))]),
      ["half of all directions", ...measurements.map((each) => known_to(each.details.known_to))]])
    : table(["reading", "value", ...(has_certainty ? ["known to"] : [])],
      all[0].map((row) => [row[0], reading_of(row), ...(has_certainty ? [certainty_of(row)] : [])]));
  made.className = "readings";
  const box = element("div", { className: `scroll${measurements.length > 2 ? " wide" : ""}${measurements.length > 4 ? " crowded" : ""}`, tabIndex: 0 }, made);
  box.setAttribute("role", "region");
  box.setAttribute("aria-label", "What instruments would read");
  return box;
}

// The sphere with the readings beside it.
const sphere_and_readings = (alt) => element("div", { className: "answer" },
  element("img", { src: data.sphere, alt, width: 320, height: 320 }), readings_table());
