// The page of gonio report in a browser: its charts and readings have their data, switches, pointer and keyboard work, it
// asks no network, it is accessible (axe), and it prints on two pages, of several files or more than three scans on three. Screenshots stay in the folder.
import { join } from "node:path";
import { readFileSync, writeFileSync } from "node:fs";
import { check, check_access, finish, folder, frames_a_second, gonio, launch, open, ready, repository } from "./browser.mjs";

const browser = await launch();
const at = (name) => join(folder, name);

// A scan of a paint in the plane of a light at 45 degrees, of which the seventh sample is five times too bright.
function write_scan(file) {
  const rows = Array.from({ length: 15 }, (_, i) => [45, 0, Math.abs(10 * i - 70), i < 7 ? 0 : 180]);
  writeFileSync(at("scan-directions.csv"), "theta_i,phi_i,theta_o,phi_o\n" + rows.join("\n") + "\n");
  gonio("expand", "--formula", "red-paint", "-o", at("red.binary"));
  gonio("sample", at("red.binary"), "--directions", at("scan-directions.csv"), "-o", at("exact.csv"));
  const lines = readFileSync(at("exact.csv"), "utf8").trim().split("\n");
  const columns = lines.find((line) => !line.startsWith("#")).split(",");
  let number = 0;
  const text = lines.map((line) => {
    if (!/^[0-9]/.test(line) || ++number !== 7) return line;
    return line.split(",").map((field, i) => ("rgb".includes(columns[i]) ? 5 * Number(field) : field)).join(",");
  });
  writeFileSync(file, text.join("\n") + "\n");
}

async function check_charts(page, name) {
  const found = await page.evaluate(() => ({
    data: { samples: data.samples.length, map: data.map.length, scans: data.scans.length, off: data.samples.filter((each) => each.disagrees).length },
    figures: [...document.querySelectorAll("figure")].filter((each) => each.querySelector(":scope > svg, :scope > figure > svg, :scope > details")).map((each) => ({
      label: each.querySelector("svg[role=img]")?.getAttribute("aria-label") ?? "",
      marks: each.querySelectorAll("svg[role=img] :is(path, rect, circle)").length,
      dots: each.querySelectorAll("svg[role=img] g[data-mark=dot] > *").length,
      fields: each.querySelectorAll("svg[role=img] g[data-mark=rect] rect").length,
      rows: each.querySelectorAll("details tbody tr").length,
      broken: /NaN|undefined|Infinity/.test(each.innerHTML),
    })),
  }));
  const { data, figures } = found;
  const map = figures.find((each) => each.label.startsWith("Map of uncertainty"));
  const residuals = figures.filter((each) => each.label.startsWith("Residuals against"));
  const scans = figures.filter((each) => each.label.startsWith("Polar plot"));
  check(figures.length === data.scans + 4, `${name}: ${figures.length} charts, ${data.scans} of them polar plots`);
  check(figures.every((each) => each.marks > 3 && each.rows > 0 && !each.broken), `${name}: every chart has marks and a table, and no number is missing`);
  check(scans.length === data.scans, `${name}: each scan has a chart`);
  // Where a sample disagrees, the map draws its cross twice, for a rim.
  check(map.fields === data.map && map.dots === data.samples + data.off, `${name}: the map has ${map.fields} fields and ${map.dots} dots`);
  check(residuals.length === 2 && residuals.every((each) => each.dots === each.rows), `${name}: residuals of ${residuals[0]?.rows} samples`);
}

// Eleven readings of each measurement, those that are not known without a number.
async function check_readings(page, name) {
  const { rows, unknown, told } = await page.evaluate(() => {
    const cells = [...document.querySelectorAll("table.readings tbody tr")].map((row) => [...row.cells].map((each) => each.textContent));
    const all = [data, ...(data.others ?? [])].map(({ readings: { known_to: known } }) =>
      [...Object.values(known.gloss), known.haze_20, known.reflectance_8, known.reflectance_8_specular_excluded, ...known.colours]);
    return { rows: cells, unknown: all.flat().filter((each) => each >= 2).length, told: cells.flat().filter((each) => /^not known/.test(each)).length };
  });
  const several = await page.evaluate(() => (data.others ?? []).length > 0);
  check(rows.length === (several ? 12 : 11) && rows.every((row) => row.slice(1).every((each) => /\d/.test(each) || each === "not known")),
    `${name}: ${rows.length} rows of readings, such as ${rows[1].join(" | ")}`);
  check(told === unknown, `${name}: ${told} of them are said not to be known`);
}

// The switches draw each scan again: its axes, and the scale that its caption tells.
async function check_switches(page, name) {
  const labels = () => page.evaluate(() => [...document.querySelectorAll(".pair svg")].map((each) => each.getAttribute("aria-label").split(" ")[0]));
  const captions = () => page.evaluate(() => [...document.querySelectorAll("figure:has(> .pair) > figcaption")].map((each) => each.textContent));
  const scale = page.locator("label", { hasText: "Scale" }).locator("select"), axes = page.locator("label", { hasText: "Axes" }).locator("select");
  const scans = await page.evaluate(() => data.scans.length), both = await labels();
  check(both.length === 2 * scans && both.every((each, i) => each === (i % 2 ? "Cartesian" : "Polar")), `${name}: ${scans} scans in polar and in Cartesian axes`);
  await scale.focus();
  await page.keyboard.press("ArrowDown");
  const linear = await captions();
  await page.keyboard.press("ArrowDown");
  const logarithmic = await captions();
  check(linear.every((each) => /radius linear$/.test(each)) && logarithmic.every((each) => /radius logarithmic, .* in the middle$/.test(each)),
    `${name}: the keyboard switches from "${linear[0]}" to "${logarithmic[0]}"`);
  const ends = await page.evaluate(() => [...document.querySelectorAll(".pair svg path")].some((each) => /NaN|Infinity/.test(each.getAttribute("d"))));
  check(!ends, `${name}: in logarithmic axes every point is drawn`);
  await axes.selectOption("cartesian");
  const one = await labels();
  check(one.length === scans && one.every((each) => each === "Cartesian"), `${name}: Cartesian axes alone`);
  await axes.selectOption("both");
  await scale.selectOption("auto");
}

// Several measurements: a name, a line and dots for each in the plots of scans and albedo, and a column of readings.
async function check_several(browser, name) {
  for (const colorScheme of ["light", "dark"]) {
    const { page, complaints, requests } = await open(browser, at(`${name}.html`), { colorScheme });
    await ready(page);
    await page.waitForTimeout(700);
    await page.screenshot({ path: at(`${name}-${colorScheme}.png`), fullPage: true });
    await check_access(page, `${name}, ${colorScheme}`);
    const { keys, columns, strokes, samples, wanted } = await page.evaluate(() => ({
      keys: [...document.querySelectorAll(".key")].map((key) => [...key.children].map((each) => each.innerText.trim())),
      columns: [...document.querySelectorAll("table.readings th")].map((each) => each.innerText.trim()).slice(1),
      wanted: data.others[0].scans.reduce((sum, each) => sum + each.samples.length, 0),
      strokes: [...document.querySelectorAll(".pair")].map((pair) => new Set([...pair.querySelectorAll("g[data-mark=line]")]
        .map((each) => each.getAttribute("stroke")).filter((each) => /--fit|--other/.test(each))).size),
      samples: document.querySelectorAll(".pair svg:first-child g[data-mark=dot][fill='var(--other-1)'] path").length }));
    const names = ["reference", "scan", "blue"];
    check(keys.length === 2 && [...keys, columns].every((each) => each.join() === names.join()), `${name}: names ${columns.join(", ")} above plots and readings`);
    check(strokes.every((each) => each === names.length) && samples === wanted && samples > 5, `${name}: ${names.length} curves in each plot, ${samples} dots of the second`);
    if (colorScheme === "light") {
      await check_readings(page, name);
      await check_switches(page, name);
      const pages = (await page.pdf({ format: "A4" })).toString("latin1").match(/\/Type\s*\/Page\b/g).length;
      check(pages <= 3, `${name}: prints on ${pages} pages`);
    }
    check(complaints.length === 0 && requests.length === 1, `${name}, ${colorScheme}: the console is empty and nothing is requested ${complaints} ${requests.slice(1)}`);
    await page.close();
  }
}

async function check_pointer(page, name) {
  const dot = page.locator("svg[role=img] g[data-mark=dot] > *").first();
  await dot.scrollIntoViewIfNeeded();
  const box = await dot.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForTimeout(200);
  const tip = await page.evaluate(() => [...document.querySelectorAll("g[aria-label=tip]")].map((each) => each.textContent).join(""));
  check(/sample \d+: theta_i/.test(tip), `${name}: a pointer over a dot tells of the sample`);
  await page.locator("canvas").first().scrollIntoViewIfNeeded();
  const canvas = await page.locator("canvas").first().boundingBox();
  await page.mouse.move(canvas.x + canvas.width * 0.4, canvas.y + canvas.height * 0.4);
  await page.locator(".readout", { hasText: "known to" }).waitFor({ timeout: 20000 }).catch(() => {});
  const readout = await page.locator(".readout").textContent();
  check(/theta_i [\d.]+.*, theta_o [\d.]+.*: [\d.e-]+, [\d.e-]+, [\d.e-]+ sr.*known to/.test(readout), `${name}: a pointer over the sphere reads "${readout}"`);
  const before = await page.evaluate(() => viewer.state.longitude);
  await page.mouse.down();
  await page.mouse.move(canvas.x + canvas.width * 0.4 + 40, canvas.y + canvas.height * 0.4, { steps: 4 });
  await page.mouse.up();
  const moved = await page.evaluate(() => viewer.state.longitude);
  check(Math.abs(moved - before - 20) < 0.1, `${name}: dragging by 40 pixels turns the light by ${moved - before} degrees`);
}

// A colour left of the canvas' middle, of the fit, after the next drawing.
const colour_of_fit = (page) => page.evaluate(() => {
  viewer.draw(1);
  const gl = viewer.view.gl, colour = new Uint8Array(4);
  gl.readPixels(0.4 * gl.drawingBufferWidth, gl.drawingBufferHeight / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, colour);
  return [...colour];
});

async function check_keyboard(page, name) {
  // Everything that can be used is reached by the tabulator key, in the order of the page.
  await page.evaluate(() => { window.scrollTo(0, 0); document.activeElement?.blur(); });
  const reached = [];
  for (let i = 0; i < 60; ++i) {
    await page.keyboard.press("Tab");
    const tag = await page.evaluate(() => (document.activeElement === document.body ? "" : document.activeElement.tagName.toLowerCase()));
    if (!tag) break;
    reached.push(tag);
  }
  const wanted = await page.evaluate(() => [...document.querySelectorAll("canvas, select, input, summary")].filter((each) => each.checkVisibility()).map((each) => each.tagName.toLowerCase()));
  check(wanted.every((tag) => reached.filter((each) => each === tag).length >= wanted.filter((each) => each === tag).length),
    `${name}: the tabulator key reaches all ${wanted.length} controls`);
  await page.locator("canvas").first().focus();
  const before = await page.evaluate(() => ({ ...viewer.state })), dark = await colour_of_fit(page);
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("ArrowDown");
  const after = await page.evaluate(() => ({ ...viewer.state }));
  check(after.longitude === before.longitude - 5 && after.latitude === before.latitude - 5, `${name}: arrow keys move the light`);
  await page.locator("label", { hasText: "Exposure" }).locator("input").focus();
  for (let i = 0; i < 8; ++i) await page.keyboard.press("ArrowRight");
  const bright = await colour_of_fit(page);
  check(bright[0] > dark[0] || dark[0] === 255, `${name}: the exposure's slider brightens, ${dark} to ${bright}`);
  await page.locator("label", { hasText: "Uncertainty" }).locator("input").focus();
  await page.keyboard.press("Space");
  const known = await colour_of_fit(page);
  check(Math.abs(known[0] - bright[0]) > 5, `${name}: the space bar shows how well directions are known, ${known}`);
  await page.keyboard.press("Space");
  await page.locator("summary").first().focus();
  await page.keyboard.press("Enter");
  check(await page.locator("details").first().evaluate((each) => each.open), `${name}: the enter key opens a table of values`);
  await page.keyboard.press("Enter");
}

// A ball of flat triangles, with smooth normals, as a file.
function write_ball(file, rows = 60, columns = 120) {
  const lines = [];
  for (let i = 0; i <= rows; ++i)
    for (let k = 0; k < columns; ++k) {
      const theta = Math.PI * i / rows, phi = 2 * Math.PI * k / columns;
      lines.push(`v ${2 + Math.sin(theta) * Math.cos(phi)} ${Math.cos(theta)} ${Math.sin(theta) * Math.sin(phi)}`);
    }
  for (let i = 0; i < rows; ++i)
    for (let k = 0; k < columns; ++k) {
      const corner = (row, column) => row * columns + (column % columns) + 1;
      lines.push(`f ${corner(i, k)} ${corner(i, k + 1)} ${corner(i + 1, k + 1)} ${corner(i + 1, k)}`);
    }
  writeFileSync(file, lines.join("\n"));
}

// The mean difference of two shapes within 0.95 of the radius, of 255.
const difference_of_shapes = (page, one, other) => page.evaluate(([one, other]) => {
  const gl = viewer.view.gl, side = gl.drawingBufferWidth;
  const [a, b] = [one, other].map((shape) => {
    const pixels = new Uint8Array(4 * side * side);
    viewer.view.draw({ ...viewer.state, exposure: 2, samples: 1, shape });
    gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return pixels;
  });
  let sum = 0, count = 0, brightest = 0;
  for (let i = 0; i < a.length; ++i) {
    const x = 2 * (((i >> 2) % side) + 0.5) / side - 1, y = 2 * (Math.floor((i >> 2) / side) + 0.5) / side - 1;
    if (i % 4 === 3 || x * x + y * y > 0.9) continue;
    sum += Math.abs(a[i] - b[i]);
    brightest = Math.max(brightest, a[i]);
    ++count;
  }
  return { mean: sum / count, brightest };
}, [one, other]);

async function check_model(page, name) {
  await page.locator("label", { hasText: "Shape" }).locator("select").selectOption("mesh");
  write_ball(at("ball.obj"));
  await page.locator("input[accept='.obj']").setInputFiles(at("ball.obj"));
  await page.waitForFunction(() => viewer.view.mesh !== null);
  const { mean, brightest } = await difference_of_shapes(page, "sphere", "mesh");
  check(mean < 1 && brightest > 50, `${name}: a ball as a file looks like the sphere, mean difference ${mean.toFixed(2)}/255`);
  writeFileSync(at("broken.obj"), "v 0 0 0\nf 1 2 3\n");
  await page.locator("input[accept='.obj']").setInputFiles(at("broken.obj"));
  await page.locator("output", { hasText: "not a model: there is no vertex 2" }).waitFor({ timeout: 20000 }).catch(() => {});
  check(await page.locator("output", { hasText: "no vertex 2" }).count() === 1, `${name}: a broken file is refused`);
  await page.locator("label", { hasText: "Shape" }).locator("select").selectOption("sphere");
}

// What stands in the middle of the image, of the fit and of what is mixed with it.
const colours_of_middle = (page, states) => page.evaluate((states) => states.map((state) => {
  const { gl } = viewer.view, side = gl.drawingBufferWidth, pixels = new Uint8Array(4 * side * side);
  viewer.view.draw({ ...viewer.state, exposure: 0.5, samples: 1, ...state });
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  return [...pixels];
}), states);

// What the halves are called, beside one another; blended they have no names.
async function check_halves(page, name) {
  const shown = (state) => page.evaluate(async (state) => {
    const before = { ...viewer.state }, slider = document.querySelector(".viewer label:not([hidden]) input[type=range]");
    const redraw = () => slider.dispatchEvent(new Event("input"));
    Object.assign(viewer.state, state);
    redraw();
    const names = [...document.querySelectorAll(".halves span")].filter((each) => each.checkVisibility()).map((each) => each.textContent);
    Object.assign(viewer.state, before);
    redraw();
    return names.join(" | ");
  }, state);
  const found = [];
  for (const state of [{ truth: 50 }, { truth: 0 }, { truth: 100 }, { truth: 50, blends: true }]) found.push(await shown({ blends: false, ...state }));
  check(found.join("; ") === "from the samples | the truth; from the samples; the truth; ", `${name}: the halves are named: ${found.join("; ")}`);
}

// By keyboard: the slider mixes the fit with the truth, which are both ends.
async function check_blend(page, name) {
  await page.locator("label", { hasText: "Truth is shown" }).locator("select").focus();
  await page.keyboard.press("ArrowDown");
  await page.locator("label", { hasText: /^Truth\d/ }).locator("input").focus();
  await page.keyboard.press("End");
  const end = await page.evaluate(() => ({ ...viewer.state }));
  await page.keyboard.press("Home");
  const start = await page.evaluate(() => ({ ...viewer.state }));
  check(end.blends && end.truth === 100 && start.truth === 0, `${name}: the keyboard blends from ${start.truth} to ${end.truth} %`);
  const [fit, none, half, all, truth] = await colours_of_middle(page, [{ truth: 0, blends: false }, { truth: 0, blends: true },
    { truth: 50, blends: true }, { truth: 100, blends: true }, { truth: 101, blends: false }]);
  const apart = (a, b) => a.reduce((most, each, i) => Math.max(most, Math.abs(each - b[i])), 0);
  check(apart(fit, none) === 0 && apart(all, truth) === 0, `${name}: both ends of the blend are fit and truth`);
  const outside = half.filter((each, i) => each < Math.min(fit[i], truth[i]) - 1 || each > Math.max(fit[i], truth[i]) + 1);
  check(outside.length === 0 && apart(half, fit) > 1 && apart(half, truth) > 1, `${name}: half of the blend lies between, ${apart(half, fit)}/255 and ${apart(half, truth)}/255 off`);
  const mixed = await page.evaluate(() => blended(0.5, (which) => (which ? [4, 1, 0.09] : [1, 1, 0.01])));
  check(Math.max(...mixed.map((each, i) => Math.abs(each - [2, 1, 0.03][i]))) < 1e-9, `${name}: tables are mixed by their logarithms`);
  await page.keyboard.press("End");
  for (let i = 0; i < 50; ++i) await page.keyboard.press("ArrowLeft");
  await page.waitForTimeout(1000);
  await page.locator(".viewer").screenshot({ path: at(`${name}-blend.png`) });
  await page.locator("label", { hasText: "Truth is shown" }).locator("select").selectOption({ label: "beside the fit" });
}

// A light probe of 8 x 4 pixels, white above and dark below.
const small_probe = Buffer.concat([Buffer.from("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n"),
  Buffer.from(Array.from({ length: 32 }, (_, i) => (i < 16 ? [128, 128, 128, 129] : [128, 64, 32, 126])).flat())]);

async function check_environment(page, name) {
  const lights = page.locator("select:has(option[value=environment])"), frames = () => page.evaluate(() => viewer.surrounded.frame);
  const file = page.locator("input[accept='.hdr']"), visible = (text) => page.locator("label", { hasText: text }).isVisible();
  await page.evaluate(() => { viewer.view.canvas.width = viewer.view.canvas.height = 64; }); // all frames in seconds
  await lights.focus();
  await page.keyboard.press("ArrowDown");
  await page.waitForFunction(() => viewer.surrounded?.frame > 8);
  check(!(await visible("Light, upwards")) && await visible("Turned, to the right") && await file.isVisible(), `${name}: an environment has its own controls`);
  const known = page.locator("label", { hasText: "Uncertainty" });
  check(await known.locator("input").isDisabled() && /choose the lamp/.test(await known.getAttribute("title")), `${name}: uncertainty needs the lamp, and says so`);
  const box = await page.locator("canvas").first().boundingBox();
  await page.mouse.move(box.x + box.width * 0.4, box.y + box.height * 0.4);
  const readout = await page.locator(".readout").textContent(), caption = await page.locator("figcaption", { hasText: "Lobe" }).textContent();
  check(/^theta_o [\d.]+/.test(readout) && /^Lobe for a view at/.test(caption), `${name}: in an environment a pointer reads "${readout}"`);
  await page.waitForFunction(() => viewer.surrounded.frame > 16);
  const before = await frames();
  await page.locator("canvas").first().focus();
  await page.keyboard.press("ArrowRight");
  const after = await page.evaluate(() => [viewer.surrounded.frame, viewer.state.around, viewer.state.longitude]);
  check(after[0] < before && after[1] === 5, `${name}: an arrow key turns the environment to ${after[1]} degrees and starts again`);
  const room = await page.evaluate(() => viewer.surrounded.white);
  const other_colours = Buffer.from(small_probe.toString("latin1").replace("rgbe", "xyze"), "latin1");
  let told = 0;
  for (const [written, bytes, problem] of [["small.hdr", small_probe, ""], ["xyz.hdr", other_colours, "its header says FORMAT=32-bit_rle_xyze"],
    ["short.hdr", small_probe.subarray(0, 100), "the file ends before its last pixel"]]) {
    writeFileSync(at(written), bytes);
    await file.setInputFiles(at(written));
    await page.waitForTimeout(300);
    if (problem) told += await page.locator("output", { hasText: `not a light probe: ${problem}` }).count();
  }
  const white = await page.evaluate(() => viewer.surrounded.white);
  check(white !== room && white > 0.4 && white < 1 && told === 2, `${name}: a light probe is taken, one in other colours and a truncated one refused`);
  await file.setInputFiles([]);
  await page.waitForFunction((room) => viewer.surrounded.white === room && viewer.surrounded.frame === last_frame, room, { timeout: 300000 });
  check(await frames() === await page.evaluate(() => last_frame), `${name}: drawing ends after ${await frames()} frames`);
  await page.locator(".viewer").screenshot({ path: at(`${name}-environment.png`) });
  await check_access(page, `${name}, in an environment`, ".viewer");
  await lights.selectOption("lamp");
  check(!(await known.locator("input").isDisabled()), `${name}: the lamp has its controls again`);
}

// Where a browser cannot draw into floats, the lamp stays.
async function check_without_floats(browser, name) {
  const page = await browser.newPage();
  await page.addInitScript(() => {
    const found = WebGL2RenderingContext.prototype.getExtension;
    WebGL2RenderingContext.prototype.getExtension = function (key) { return key === "EXT_color_buffer_float" ? null : found.call(this, key); };
  });
  await page.goto(`file://${at(`${name}.html`)}`);
  await ready(page);
  await page.locator("select:has(option[value=environment])").selectOption("environment");
  const told = await page.locator("output", { hasText: "no environment: this browser cannot draw into floats" }).count();
  check(told === 1 && await page.evaluate(() => viewer.state.light === "lamp"), `${name}: without float framebuffers the lamp stays, and the page says why`);
  await page.close();
}

async function check_page(browser, name) {
  const file = at(`${name}.html`), size = readFileSync(file).length;
  check(size < 4e6, `${name}: the page has ${(size / 1e6).toFixed(2)} MB`);
  for (const colorScheme of ["light", "dark"]) {
    const { page, complaints, requests } = await open(browser, file, { colorScheme });
    await ready(page);
    await page.waitForTimeout(700);
    await page.screenshot({ path: at(`${name}-${colorScheme}.png`), fullPage: true });
    await check_access(page, `${name}, ${colorScheme}`);
    if (colorScheme === "light") {
      await check_charts(page, name);
      await check_readings(page, name);
      await check_keyboard(page, name);
      await check_switches(page, name);
      await check_pointer(page, name);
      await check_model(page, name);
      if (await page.evaluate(() => data.viewer.truth !== undefined)) {
        await check_halves(page, name);
        await check_blend(page, name);
      }
      if (name === "scattered") await check_environment(page, name);
      const pdf = await page.pdf({ path: at(`${name}.pdf`), format: "A4" });
      const pages = pdf.toString("latin1").match(/\/Type\s*\/Page\b/g).length;
      const scans = await page.evaluate(() => data.scans.length);
      check(pages <= (scans > 3 ? 3 : 2), `${name}: prints on ${pages} pages`);
      for (const side of [256, 512])
        console.log(`- ${name}: ${(await frames_a_second(page, side)).toFixed(0)} frames a second of ${side} x ${side} pixels, WebGL in software`);
    }
    check(complaints.length === 0, `${name}, ${colorScheme}: the console is empty ${complaints}`);
    check(requests.length === 1, `${name}, ${colorScheme}: no request but the page itself ${requests.slice(1)}`);
    await page.close();
  }
}

// Pages without a viewer: of gonio check, gonio fit and gonio design.
async function check_plain_page(browser, name, charts) {
  for (const colorScheme of ["light", "dark"]) {
    const { page, complaints, requests } = await open(browser, at(`${name}.html`), { colorScheme });
    await page.waitForSelector("table.record");
    await page.screenshot({ path: at(`${name}-${colorScheme}.png`), fullPage: true });
    await check_access(page, `${name}, ${colorScheme}`);
    const figures = await page.evaluate(() => [...document.querySelectorAll("figure")].map((each) => ({
      is_albedo: /^Albedo/.test(each.querySelector("svg[role=img]").getAttribute("aria-label")), dots: each.querySelectorAll("g[data-mark=dot] > *").length, rows: each.querySelectorAll("tbody tr").length, broken: /NaN|undefined|Infinity/.test(each.innerHTML) })));
    check(figures.length === charts && figures.every((each) => each.rows > 0 && (each.is_albedo || each.dots >= each.rows) && !each.broken), `${name}: ${figures.length} charts, each direction in all of them`);
    if (colorScheme === "light") {
      const pages = (await page.pdf({ format: "A4" })).toString("latin1").match(/\/Type\s*\/Page\b/g).length;
      check(pages <= 2, `${name}: prints on ${pages} pages`);
    }
    check(complaints.length === 0 && requests.length === 1, `${name}, ${colorScheme}: the console is empty and nothing is requested ${complaints} ${requests.slice(1)}`);
    await page.close();
  }
}

write_scan(at("scan.csv"));
gonio("report", at("scan.csv"), "--noise", "0.02", "-o", at("scan.html"));
if (!process.env.GONIO_CHROMIUM) { // which need not be on the PATH
  gonio("report", at("scan.csv"), "--noise", "0.02", "-o", at("printed.pdf"));
  check(/^%PDF-/.test(readFileSync(at("printed.pdf"), "latin1")), "gonio report -o printed.pdf: chromium prints the page");
}
gonio("sample", at("red.binary"), "--directions", join(repository, "examples/data/nielsen-20.csv"), "-o", at("scattered.csv"));
gonio("report", at("scattered.csv"), "--truth", at("red.binary"), "-o", at("scattered.html"));
gonio("sample", at("red.binary"), "--count", "1500", "--noise", "0.05", "-o", at("many.csv"));
gonio("report", at("many.csv"), "-o", at("many.html"));

gonio("sample", at("red.binary"), "--directions", at("scan-directions.csv"), "--noise", "0.02", "-o", at("reference.csv"));
try { gonio("check", at("scan.csv"), "--reference", at("reference.csv"), "--noise", "0.02", "--report", at("check.html")); } catch { /* exit code 1: it differs */ }
gonio("expand", "--formula", "blue-rubber", "-o", at("blue.binary"));
gonio("sample", at("blue.binary"), "--directions", at("scan-directions.csv"), "--noise", "0.02", "-o", at("blue.csv"));
gonio("report", at("reference.csv"), at("scan.csv"), at("blue.csv"), "--noise", "0.02", "-o", at("several.html"));
gonio("fit", at("reference.csv"), "--model", "ggx", "--report", at("fit-samples.html"));
gonio("fit", at("red.binary"), "--model", "ggx", "--report", at("fit-table.html"));
gonio("design", "-n", "6", "-o", at("six.csv"), "--report", at("design.html"));
gonio("design", "-n", "3", "--given", at("reference.csv"), "--noise", "0.02", "-o", at("three.csv"), "--report", at("given.html"));

await check_several(browser, "several");
await check_plain_page(browser, "check", 3);
await check_plain_page(browser, "fit-samples", 5);
await check_plain_page(browser, "fit-table", 6);
await check_plain_page(browser, "design", 1);
await check_plain_page(browser, "given", 1);
for (const name of ["scan", "scattered", "many"]) await check_page(browser, name);
await check_without_floats(browser, "scan");
await browser.close();

const without = await launch("--disable-3d-apis");
const { page, complaints } = await open(without, at("scan.html"));
await ready(page);
check(await page.locator(".no-viewer", { hasText: "has no WebGL 2" }).count() === 1 && await page.locator("canvas").count() === 0, "without WebGL the page says so");
check(complaints.every((each) => /webgl/i.test(each)), `without WebGL the console has nothing else ${complaints}`);
await without.close();
finish();
