// In-plane scans of a page: the fit and the samples in the plane of incidence, in polar and in Cartesian axes.

const scan_choices = { scale: "auto", axes: "both" };

// Returns the radius of a reflectance: linear or logarithmic as `wanted`, or by default logarithmic if the values vary
// by a factor of 6 or more, so a highlight does not hide all else. Rings are at round values.
function radius_of(values, wanted = "auto") {
  const largest = Math.max(...values), smallest = Math.min(...values.filter((value) => value > 0));
  if (!(largest > 0)) return { rings: [], radius: () => 0, kind: "of no meaning: nothing is reflected", type: "linear", domain: [0, 1] };
  if (wanted === "linear" || (wanted === "auto" && largest / smallest < 6)) {
    const step = [1, 2, 5, 10].map((k) => k * 10 ** Math.floor(Math.log10(largest / 4))).find((k) => largest / k <= 4.5);
    const end = Math.ceil(largest / step) * step, rings = [];
    for (let k = 1; k * step <= end * 1.0001; ++k) rings.push(k * step);
    return { rings, radius: (value) => Math.max(value, 0) / end, kind: "linear", type: "linear", domain: [0, end] };
  }
  const low = Math.floor(Math.log10(Math.max(smallest, largest * 1e-7))), high = Math.max(Math.ceil(Math.log10(largest)), low + 1);
  const rings = [];
  for (let k = low + 1; k <= high; ++k) rings.push(10 ** k);
  return { rings, radius: (value) => Math.max(Math.log10(Math.max(value, 1e-30)) - low, 0) / (high - low),
    kind: `logarithmic, ${digits(10 ** low)} in the middle`, type: "log", domain: [10 ** low, 10 ** high] };
}

const curve_start = -87, curve_step = 0.5; // degrees, of all curves

// Returns the luminances in a plane by the viewer's angle, of the page's measurement and of the others.
function plane_of(scan, number) {
  const samples = scan.samples.map((sample) => by_number.get(sample)).map((each) => ({ ...each, angle: each.in_plane, y: luminance(each.measured) }));
  const fit = scan.curve.map((each) => ({ ...each, y: luminance(each.fit) }));
  // Where there is no sample, the fit has tips.
  const between = fit.filter((each) => samples.every((point) => Math.abs(point.angle - each.angle) > 1.5))
    .map((each) => ({ ...each, tip: `viewer ${angle(each.angle)}\nfit ${channels(each.fit)}${known_suffix(each)}` }));
  const beside = measurements.slice(1).map(({ name, look, scans }) => ({
    name, look,
    curve: scans[number].curve.map((y, i) => ({ angle: curve_start + curve_step * i, y })),
    samples: scans[number].samples.map((each) => ({ ...each, angle: each.in_plane, y: each.luminance,
      tip: `${name}, sample ${each.sample}: theta_o ${angle(Math.abs(each.in_plane))}\nmeasured ${digits(each.luminance)}` })),
  }));
  const all = [...fit, ...samples, ...beside.flatMap((each) => [...each.curve, ...each.samples])];
  return { theta_i: scan.theta_i, samples, fit, between, beside, values: all.map((each) => each.y) };
}

// Returns band, lines and dots at the points `project(angle, value)`.
function marks_of_plane({ samples, fit, between, beside }, project) {
  const placed = (all) => all.map((each) => ({ ...each, at: project(each.angle, each.y) }));
  const x = (each) => each.at.x, y = (each) => each.at.y;
  const outer = fit.map((each) => project(each.angle, each.y * (1 + (each.known_to ?? 0))));
  const inner = fit.map((each) => project(each.angle, each.y / (1 + (each.known_to ?? 0)))).reverse();
  return [
    Plot.line([...outer, ...inner], { x: "x", y: "y", fill: "var(--fit)", fillOpacity: 0.22, stroke: "none", curve: "linear-closed" }),
    ...beside.map(({ look, curve }) => Plot.line(placed(curve), { x, y, stroke: look.stroke, strokeWidth: 2, strokeDasharray: look.dashes })),
    Plot.line(placed(fit), { x, y, stroke: "var(--fit)", strokeWidth: 2 }),
    ...beside.map((each) => Plot.dot(placed(each.samples), { x, y, r: 4, symbol: each.look.symbol, fill: each.look.dot, stroke: "var(--paper)" })),
    ...samples_as_marks(placed(samples), x, y, placed([...beside.flatMap((each) => each.samples), ...between])),
  ];
}

// Returns the light and, if it is more than 8 degrees from the normal, the mirror direction, with their dashes.
const named_directions = (theta_i) => [{ at: -theta_i, name: "light", dashes: "7 4" }, { at: theta_i, name: "mirror", dashes: "2 4" }]
  .slice(0, theta_i > 8 ? 2 : 1);

function polar_plot(plane, { rings, radius }) {
  const ray = (degrees, r) => ({ x: r * Math.sin(radians(degrees)), y: r * Math.cos(radians(degrees)) });
  const ring = (r) => Array.from({ length: 181 }, (_, i) => ray(i - 90, r));
  const spoke = (degrees, options) => Plot.line([ray(degrees, 0), ray(degrees, 1.04)], { x: "x", y: "y", ...options });
  // Names are outside the last ring, where they hide no curve. A name replaces the angle of a spoke near it.
  const named = named_directions(plane.theta_i);
  const angles = [-60, -30, 0, 30, 60].filter((at) => named.every((each) => Math.abs(each.at - at) > 9));
  const beyond = ({ at }) => ray(at, 1.09 + 0.04 * Math.abs(Math.sin(radians(at))));
  const label = { x: (each) => beyond(each).x, y: (each) => beyond(each).y, text: "name", fill: "var(--soft)" };
  return Plot.plot({
    width: 520, height: 284, margin: 10, marginBottom: 24, axis: null,
    x: { domain: [-1.16, 1.16] }, y: { domain: [0, 1.16] },
    marks: [
      ...rings.map((value) => Plot.line(ring(radius(value)), { x: "x", y: "y", stroke: "var(--line)" })),
      ...[-90, -60, -30, 0, 30, 60, 90].map((at) => spoke(at, { stroke: "var(--line)" })),
      ...named.map(({ at, dashes }) => spoke(at, { stroke: "var(--soft)", strokeDasharray: dashes, strokeWidth: 1.5 })),
      Plot.text([...angles.map((at) => ({ at, name: angle(at) })), ...named], label),
      Plot.text(rings.filter((_, i) => (rings.length - 1 - i) % Math.ceil(rings.length / 5) === 0), { x: radius, y: 0, text: digits, dy: 11, fill: "var(--soft)" }),
      ...marks_of_plane(plane, (degrees, value) => ray(degrees, Math.min(radius(value), 1.12))),
    ],
  });
}

function cartesian_plot(plane, { type, domain, rings }) {
  const named = named_directions(plane.theta_i), label = { x: "at", y: domain[1], text: "name", dy: -9, fill: "var(--soft)" };
  return Plot.plot({
    width: 520, height: 284, marginLeft: 52, marginTop: 26, marginBottom: 36,
    x: { domain: [-90, 90], ticks: [-90, -60, -30, 0, 30, 60, 90], label: "viewer, degrees from the normal" },
    y: { type, domain, grid: true, clamp: true, label: "sr\u207b\u00b9", ticks: [domain[0], ...rings], tickFormat: digits },
    marks: [
      ...named.map(({ at, dashes }) => Plot.ruleX([at], { stroke: "var(--soft)", strokeDasharray: dashes, strokeWidth: 1.5 })),
      Plot.text(named, label),
      ...marks_of_plane(plane, (x, y) => ({ x, y: Math.max(y, domain[0]) })),
    ],
  });
}

// Returns a sentence that explains the dots.
function told_of_dots(measured, has_band) {
  if (data.of_table) return "Dots: the table. ";
  if (!measured) return "No three samples lie in the plane of one light: this is the fit alone. ";
  return has_band ? "Dots: samples; crosses: those that disagree. " : "Dots: samples. ";
}

// Returns the values of a plane by the viewer's angle: of samples or, if there are none, of the fit every five degrees.
function values_of_plane({ samples, fit, beside }, has_band) {
  const known = (each) => (has_band ? [percent(each.known_to)] : []);
  const of_others = (degrees) => beside.map(({ curve }) => digits(curve[Math.round((degrees - curve_start) / curve_step)]?.y ?? NaN));
  const at = (degrees) => fit[Math.round((degrees - curve_start) / curve_step)];
  const rows = samples.length
    ? [...samples.map((each) => [each.angle, String(each.sample), channels(each.measured), channels(each.fit), ...known(each)]),
      ...beside.flatMap(({ name, samples: theirs }) => theirs.filter((each) => at(each.angle)).map((each) =>
        [each.angle, `${name}, ${each.sample}`, digits(each.y), channels(at(each.angle).fit), ...known(at(each.angle))]))]
    : fit.filter((each) => each.angle % 5 === 0).map((each) => [each.angle, "", "", channels(each.fit), ...known(each)]);
  return { head: ["viewer", "sample", "measured", "fit", ...(has_band ? ["known to"] : []), ...beside.map((each) => each.name)],
    rows: rows.sort((a, b) => a[0] - b[0]).map(([degrees, ...cells]) => [angle(degrees), ...cells, ...of_others(degrees)]) };
}

// Returns a figure of a plane, and a function that draws it again as chosen.
function plane_figure(plane, has_band) {
  const { theta_i, samples, fit, values } = plane, light = `Light at ${angle(theta_i)}`;
  const peak = fit.reduce((best, each) => (each.y > best.y ? each : best));
  const { head, rows } = values_of_plane(plane, has_band);
  const pair = element("div", { className: "pair" });
  const told = ` for light at ${angle(theta_i)}: ${samples.length} samples; the fit is largest at ${angle(peak.angle)}, ${digits(peak.y)} per steradian`;
  const made = captioned(pair, "", head, rows), caption = made.querySelector("figcaption");
  const draw = () => {
    const scale = radius_of(values, scan_choices.scale), { axes } = scan_choices;
    pair.replaceChildren(
      ...(axes === "cartesian" ? [] : [described(polar_plot(plane, scale), "Polar plot" + told)]),
      ...(axes === "polar" ? [] : [described(cartesian_plot(plane, scale), "Cartesian plot" + told)]));
    caption.textContent = `${light}; ${axes === "cartesian" ? (scale.type === "log" ? "logarithmic" : scale.kind) : `radius ${scale.kind}`}`;
  };
  return { made, draw };
}

function scans() {
  const has_band = data.scans.some((scan) => scan.curve.some((each) => each.known_to !== undefined));
  const measured = data.scans.some((scan) => scan.samples.length);
  const band = has_band ? ` Band: in 68 of 100 cases the truth is within${others.length ? `, of ${measurements[0].name} alone` : ""}.` : "";
  add(element("h2", {}, measured ? "In-plane scans" : "In the plane of incidence"),
    paragraph(told_of_dots(measured, has_band) + `Line: the fit.${band} The luminance of the BRDF, sr\u207b\u00b9; dashes: the light; dots: its mirror direction.`),
    ...key_of_measurements());
  const figures = data.scans.map((scan, number) => plane_figure(plane_of(scan, number), has_band));
  const charts = element("div", {}, ...figures.map((each) => each.made));
  const draw = () => {
    charts.className = scan_choices.axes === "both" ? "charts pairs" : "charts";
    figures.forEach((each) => each.draw());
  };
  add(element("div", { className: "controls switches screen-only" },
    choice("Scale", "scale", [["auto", "by the values"], ["linear", "linear"], ["log", "logarithmic"]], draw, scan_choices),
    choice("Axes", "axes", [["both", "polar and Cartesian"], ["polar", "polar"], ["cartesian", "Cartesian"]], draw, scan_choices)), charts);
  draw();
}
