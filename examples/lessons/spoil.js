// Lesson 3: a click corrupts a sample, and two fits are recomputed.

const factor = 8, channel = 0; // red, of a red paint
const fits = [
  { name: "All samples count", rejects: 0, colour: "var(--wrong)", dash: "7,4", command: "gonio reconstruct --no-reject" },
  { name: "Contradicted ones left out", rejects: 1, colour: "var(--fit)", dash: "none", command: "gonio reconstruct" },
];
const lesson = { spoiled: new Set(), found: [], focused: 0, scan: null, fit_again: null };
const signed = (degrees) => `${degrees < 0 ? "\u2212" : ""}${Math.abs(degrees)}\u00b0`;
const reds = (numbers) => numbers.filter((_, i) => i % 3 === channel);

// Returns the samples, including the corrupted ones, in three channels.
const now = (measured) => measured.map((value, i) => (lesson.spoiled.has(Math.floor(i / 3)) ? factor * value : value));

function fit(computed, scan, { rejects }) {
  const left = computed.ask("fit_scan", now(scan.measured), rejects), count = scan.angles.length;
  return { delta_e: left[0], rms: left[1], wrong: left.slice(2, 2 + count), curve: left.slice(2 + count) };
}

// ---- the chart -------------------------------------------------------------------------------------------------
const curve_points = (scan, curve) => reds(curve).map((value, i) => ({ angle: scan.curve_angles[i], value }));

function scan_chart(scan) {
  const values = reds(now(scan.measured)), wrong = lesson.found[1].wrong;
  const samples = scan.angles.map((angle, i) => ({ angle, value: values[i], spoiled: lesson.spoiled.has(i), left_out: wrong[i] > 0 }));
  const left_out = samples.filter((each) => each.left_out);
  return without_names(Plot.plot({
    width: width_of(860), height: 430, marginLeft: 60, marginBottom: 44, style: { fontSize: "13px" },
    x: { domain: [-88, 88], label: "viewer, degrees from the normal; the light is at \u221245", labelArrow: "none", labelAnchor: "center", ticks: [-75, -45, -15, 15, 45, 75] },
    y: { type: "log", domain: [0.08, 8], label: "red reflectance, sr\u207b\u00b9", ticks: [0.1, 0.2, 0.5, 1, 2, 5], tickFormat: String, grid: true, clamp: true },
    marks: [
      Plot.line(curve_points(scan, scan.truth), { x: "angle", y: "value", stroke: "var(--soft)", strokeWidth: 5, strokeOpacity: 0.4 }),
      ...fits.map(({ colour, dash }, i) => Plot.line(curve_points(scan, lesson.found[i].curve), { x: "angle", y: "value", stroke: colour, strokeWidth: 2, strokeDasharray: dash })),
      Plot.dot(samples, { x: "angle", y: "value", r: 6, fill: (each) => (each.spoiled ? "var(--wrong)" : "var(--ink)"), stroke: "var(--paper)", strokeWidth: 1.5 }),
      Plot.dot(left_out, { x: "angle", y: "value", r: 11, symbol: "times", stroke: "var(--fit)", strokeWidth: 3 }),
    ],
  }));
}

// Makes every sample a button. The tab key reaches one of them, arrow keys the others.
function make_buttons(chart, scan, toggle) {
  chart.setAttribute("role", "group");
  chart.setAttribute("aria-label", "Samples and fits against the viewer's angle: each sample is a button that spoils or restores it");
  const [dots, crosses] = chart.querySelectorAll("g[data-mark=dot]"), buttons = [...dots.children];
  if (crosses) crosses.style.pointerEvents = "none";
  const focus = (i) => {
    buttons[lesson.focused].setAttribute("tabindex", -1);
    lesson.focused = Math.min(Math.max(i, 0), buttons.length - 1);
    buttons[lesson.focused].setAttribute("tabindex", 0);
    buttons[lesson.focused].focus();
  };
  buttons.forEach((button, i) => {
    button.setAttribute("role", "button");
    button.setAttribute("tabindex", i === lesson.focused ? 0 : -1);
    button.setAttribute("aria-pressed", lesson.spoiled.has(i));
    button.setAttribute("aria-label", `Sample at ${signed(scan.angles[i])}` + (lesson.spoiled.has(i) ? `, ${factor} times too bright` : "") + (lesson.found[1].wrong[i] > 0 ? ", left out" : ""));
    button.addEventListener("click", () => { lesson.focused = i; toggle(i); });
    button.addEventListener("keydown", (event) => {
      const steps = { ArrowLeft: i - 1, ArrowRight: i + 1, Home: 0, End: buttons.length - 1 };
      if (event.key in steps) focus(steps[event.key]);
      else if (event.key === "Enter" || event.key === " ") toggle(i);
      else return;
      event.preventDefault();
    });
  });
  return { chart, focus: () => buttons[lesson.focused].focus() };
}

// ---- the page --------------------------------------------------------------------------------------------------
const angles_of = (scan, numbers) => (numbers.length ? numbers.map((i) => signed(scan.angles[i])).join(", ") : "none");
const left_out = ({ wrong }) => wrong.flatMap((probability, i) => (probability > 0 ? [i] : []));

function told(scan) {
  const spoiled = [...lesson.spoiled].sort((a, b) => a - b), rejected = left_out(lesson.found[1]);
  if (!spoiled.length && !rejected.length) return "No sample is spoiled, and none is left out.";
  const missed = spoiled.filter((i) => !rejected.includes(i)), wronged = rejected.filter((i) => !spoiled.includes(i));
  return `Spoiled: ${angles_of(scan, spoiled)}. Left out: ${angles_of(scan, rejected)}.` +
    (missed.length ? ` Not noticed: ${angles_of(scan, missed)}.` : "") + (wronged.length ? ` Left out although right: ${angles_of(scan, wronged)}.` : "");
}

const legend = () => element("ul", { className: "curves" },
  element("li", {}, element("span", { className: "truth line" }), "the truth"),
  ...fits.map(({ name, colour, dash }) => {
    const line = element("span", { className: "line" });
    line.style.borderTop = `3px ${dash === "none" ? "solid" : "dashed"} ${colour}`;
    return element("li", {}, line, name);
  }),
  element("li", {}, "\u25cf a sample, orange where it is spoiled"), element("li", {}, "\u2715 left out"));

async function fill_scan(section, computed) {
  const scan = lesson.scan = { angles: computed.ask("sample_angles"), curve_angles: computed.ask("curve_angles"), measured: computed.ask("measure_scan"), truth: computed.ask("true_curve") };
  const figure = element("figure"), values = element("div"), status = element("p");
  status.setAttribute("role", "status");
  const fit_again = lesson.fit_again = (keeps_focus) => {
    lesson.found = fits.map((each) => fit(computed, scan, each));
    const { chart, focus } = make_buttons(scan_chart(scan), scan, toggle);
    figure.replaceChildren(chart);
    if (keeps_focus) focus();
    status.textContent = told(scan);
    values.replaceChildren(table(["fit", "as computed by", "Delta E of a sphere", "mapped rms", "left out"],
      fits.map(({ name, command }, i) => [name, command, lesson.found[i].delta_e.toFixed(2), lesson.found[i].rms.toFixed(3), i ? angles_of(scan, left_out(lesson.found[i])) : "-"]),
      "How far from the truth, over all directions"));
  };
  const toggle = (i) => {
    if (!lesson.spoiled.delete(i)) lesson.spoiled.add(i);
    fit_again(true);
  };
  const restore = element("button", { type: "button" }, "Restore all");
  restore.addEventListener("click", () => { lesson.spoiled.clear(); fit_again(false); });
  fit_again(false);
  section.append(legend(), figure, restore, status, values);
}

open_lesson("Spoil a sample",
  [`A red paint, scanned in the plane of the light and the normal: 31 samples with 2 % of noise. Click a sample, or press Enter on it, and it becomes ${factor} times too bright; once more restores it. Arrow keys go from sample to sample.`],
  async (computed) => {
    const section = element("section", {}, element("h2", {}, "Two fits"));
    page.append(section);
    await fill_scan(section, computed);
    page.append(element("section", {}, element("h2", {}, "What to try"), element("ul", {},
      element("li", {}, "Spoil any one sample. The fit that counts all of them follows it, and its Delta E rises."),
      element("li", {}, "Spoil the one at 45\u00b0, in the highlight. It is not noticed: who could tell it from a better polish?"),
      element("li", {}, "Spoil those at 0\u00b0, 5\u00b0 and 10\u00b0. Three that tell the same story support each other, and are found all the same: sets are compared, not single samples."),
      element("li", {}, "Spoil those from \u221235\u00b0 to \u221220\u00b0: all four are found, and no right one beside them is left out."))),
      paragraph("The estimator is gonio itself, compiled for this page, on the prior that ships; the scan is of red-paint, a formula that the prior does not contain. " +
        "A scan in one plane leaves much open: the error over all directions is not zero without any spoiled sample.", "soft"));
  });
