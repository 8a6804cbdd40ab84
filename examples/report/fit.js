// The parts of the page of gonio fit --report: an analytic model of samples or of a table.

// Returns the median difference of luminance between measurement and model, relative to the model.
function median_distance() {
  const all = data.samples.map((each) => Math.abs(luminance(each.measured) / luminance(each.fit) - 1)).filter(Number.isFinite).sort((a, b) => a - b);
  return all.length ? all[Math.floor(all.length / 2)] : NaN;
}

function fit_answer() {
  const { details } = data, distance = median_distance();
  const rows = details.lobes.map((lobe) => [lobe.lobe, channels(lobe.colour),
    Object.entries(lobe.parameters ?? {}).map(([name, value]) => `${name} ${Array.isArray(value) ? channels(value) : digits(value)}`).join(", ")]);
  add(element("h1", {}, data.name), sphere_and_readings("A sphere of the model under two lights"),
    paragraph(`Half of the ${data.of_table ? "values of the table below" : "samples"} are within ${percent(distance)} of the model.`, "headline"),
    element("div", { className: "scroll" }, table(["lobe", "colour", "parameters"], rows)),
    paragraph(`${details.measurements} measurements, loss ${digits(details.loss)} after ${details.evaluations} evaluations` +
      (details.converged ? "." : ", which did not converge."), "soft"));
}
