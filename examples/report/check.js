// The parts of the page of gonio check --report: whether a part reflects like a reference, and where it does not.

const signed_percent = (share) => `${share >= 0 ? "+" : "\u2212"}${Number((100 * Math.abs(share)).toPrecision(2))} %`;
const probability = (value) => (value < 1e-4 ? "p < 0.0001" : `p = ${digits(value)}`);
const relative = (mapped) => Math.expm1(mapped);

// Returns each direction with its channel that differs most.
function compared_directions() {
  return data.check.directions.map((each) => {
    const off_by = each.mapped_difference.map((difference, c) => difference / each.mapped_deviation[c]);
    const worst = off_by.reduce((best, value, c) => (Math.abs(value) > Math.abs(off_by[best]) ? c : best), 0);
    return { ...each, channel: data.check.channels[worst], residual: off_by[worst], difference: relative(each.mapped_difference[worst]),
      deviation: relative(each.mapped_deviation[worst]), grazing: Math.max(each.theta_i, each.theta_o),
      disagrees: each.adjusted_p_value < data.check.false_alarms };
  });
}

const told_of_direction = (each) => [`sample ${each.sample}: ${where(each)}`, `part ${channels(each.measured)}`,
  `the reference ${each.reference_samples ? "says" : "predicts"} ${channels(each.reference)}`,
  `${signed_percent(each.difference)} in ${each.channel}, ${digits(Math.abs(each.residual))} deviations`, `${probability(each.adjusted_p_value)}`].join("\n");

function check_answer() {
  const { check } = data, all = compared_directions(), differing = all.filter(is_off);
  const verdict = element("div", { className: check.conforms ? "agree" : "disagree" });
  const shift = check.shift.map(signed_percent);
  verdict.append(paragraph(`In all directions together: ${check.channels.map((name, channel) => `${name} ${shift[channel]}`.trim()).join(", ")} (${probability(check.shift_p_value)}).`));
  for (const each of differing.sort((a, b) => a.adjusted_p_value - b.adjusted_p_value).slice(0, 6))
    verdict.append(paragraph(`\u2715 Sample ${each.sample} (${where(each)}): ${signed_percent(each.difference)} in ${each.channel}, ${probability(each.adjusted_p_value)}.`));
  if (!differing.length) verdict.append(paragraph("No single direction differs."));
  add(element("h1", {}, data.name),
    paragraph(check.conforms ? "GO: no difference found." : "NO-GO: the part differs from the reference.", "headline"), verdict,
    paragraph(`${probability(check.p_value)}. Of parts like the reference, ${percent(check.false_alarms)} are said to differ` +
      (check.delta_e_tolerance > 0 ? `; colours may be off by a Delta E of ${digits(check.delta_e_tolerance)}.`
        : check.tolerance.some((each) => each > 0) ? `; differences up to ${check.tolerance.map(percent).join(", ")} are tolerated.` : "."), "soft"));
  if (check.predicted > 0)
    add(paragraph(`Note: ${check.predicted} of ${all.length} directions are not in the reference, which predicts them: there only gross differences can be seen.`, "soft"));
  add(paragraph(`Known materials explain the part ${check.familiarity.p_value < 0.01 ? "badly" : "well"} (${probability(check.familiarity.p_value)}).`, "soft"));
}

function check_differences() {
  add(element("h2", {}, "Differences by direction"),
    paragraph("By how many deviations the part is above or below the reference, in the channel that is off most. 95 of 100 should be in the band. Crosses: directions that differ."));
  residual_charts(compared_directions(), { title: "Differences", unit: "deviations", has_band: true, tip: told_of_direction,
    head: ["part", "reference"], values: (each) => [each.measured, each.reference] });
}

function check_places() {
  const all = compared_directions();
  add(element("h2", {}, "Where was compared"), paragraph("Dots: directions in which no difference is found; crosses: those that differ, with their numbers; hollow: the reference predicts them only."));
  const chart = Plot.plot({ ...angle_axes, marks: [
    Plot.gridX({ stroke: "var(--line)" }), Plot.gridY({ stroke: "var(--line)" }),
    Plot.dot(all.filter((each) => !is_off(each)), { x: "theta_h", y: "theta_d", r: 4, fill: (each) => (each.reference_samples ? "var(--ink)" : "var(--paper)"), stroke: "var(--ink)" }),
    Plot.dot(all.filter(is_off), { x: "theta_h", y: "theta_d", r: 6, symbol: "times", stroke: "var(--wrong)", strokeWidth: 2.5 }),
    Plot.text(all.filter(is_off), { x: "theta_h", y: "theta_d", text: (each) => String(each.sample), dx: 8, dy: -8, textAnchor: "start", fill: "var(--wrong)", fontWeight: 700 }),
    Plot.tip(all, Plot.pointer({ x: "theta_h", y: "theta_d", title: told_of_direction })),
  ] });
  add(figure(chart, `Map of ${all.length} directions over half and difference angle; ${all.filter(is_off).length} differ`, "Left: the highlight; top: grazing light and viewer.",
    ["sample", "theta_h", "theta_d", "difference", "known to", "p"],
    all.map((each) => [String(each.sample), angle(each.theta_h), angle(each.theta_d), `${signed_percent(each.difference)} ${each.channel}`, percent(each.deviation), probability(each.adjusted_p_value)])));
}
