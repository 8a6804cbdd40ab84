// The pages of the lessons that compute (examples/lessons) in a browser: what they show is what gonio computes, pointer
// and keyboard work, they ask no network, and they are accessible (axe). Screenshots stay in the folder.
import { join } from "node:path";
import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { check, check_access, finish, folder, gonio, launch, open, repository, skip } from "./browser.mjs";

const browser = await launch();
const at = (name) => join(folder, name);
const libraries = "/usr/lib/llvm-19/lib/wasm32-wasi/libc++.a";
if (!existsSync(libraries)) skip("cmake -P cmake/lessons.cmake installs what compiles the estimator to WebAssembly");
execFileSync("cmake", ["-D", `OUTPUT=${folder}`, "-P", join(repository, "cmake/lessons.cmake")], { stdio: "ignore" });

const worst_ratio = (a, b) => a.reduce((most, each, i) => Math.max(most, Math.abs(Math.log(each / b[i]))), 0);
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const reported = (file) => JSON.parse(readFileSync(file, "utf8").match(/<script id="data" type="application\/json">(.*?)<\/script>/s)[1]);

// Red, green and blue of the tool's table in directions, a row of angles each.
function sampled(table, head, rows) {
  writeFileSync(at("directions.csv"), `${head}\n${rows.map((row) => row.join(",")).join("\n")}\n`);
  gonio("sample", table, "--directions", at("directions.csv"), "-o", at("sampled.csv"));
  const lines = readFileSync(at("sampled.csv"), "utf8").trim().split("\n").filter((line) => !line.startsWith("#"));
  const columns = lines[0].split(",");
  return lines.slice(1).map((line) => ["r", "g", "b"].map((name) => Number(line.split(",")[columns.indexOf(name)])));
}

// ---- components by slider --------------------------------------------------------------------------------------
const errors_ready = (page) => page.locator("[role=status]", { hasText: "of 100 components" }).waitFor({ timeout: 300000 });

async function move(page, label, key, times) {
  await page.locator("label", { hasText: label }).locator("input").focus();
  for (let i = 0; i < times; ++i) await page.keyboard.press(key);
}

// The table on the sphere (0), or on its right half (1), beside a table of the tool: how far apart some of the prior's
// cells are, which are among those of a table that gonio writes.
async function apart_from(page, side, file) {
  const cells = await page.evaluate((side) => {
    const table = typeof library === "undefined" ? shown_table : library.tables[side];
    const { grid: [heights, rows, columns] } = table.cells, found = [];
    for (let cell = 0; cell < table.numbers.length; cell += 991) {
      const h = Math.floor(cell / (rows * columns)), d = Math.floor(cell / columns) % rows, p = cell % columns;
      const texel = [0, 1, 2, 3].map((k) => table.texels[4 * cell + k]);
      found.push({ angles: [90 * ((h + 0.5) / heights) ** 2, 90 * (d + 0.5) / rows, 180 * (p + 0.5) / columns],
        value: texel.slice(0, 3).map((each) => each / texel[3] * 16384 * table.scale) });
    }
    return found;
  }, side);
  // Those above the horizon.
  const radians = (degrees) => degrees * Math.PI / 180;
  const valid = cells.filter(({ angles: [h, d, p] }) => {
    const sum = Math.cos(radians(h)) * Math.cos(radians(d)), difference = Math.sin(radians(h)) * Math.sin(radians(d)) * Math.cos(radians(p));
    return sum - Math.abs(difference) > 0.001;
  });
  const truth = sampled(file, "theta_h,theta_d,phi_d", valid.map(({ angles }) => angles));
  return { count: valid.length, off: worst_ratio(valid.flatMap(({ value }) => value), truth.flat()) };
}

async function check_material(page) {
  const middle = () => page.evaluate(() => {
    viewer.draw(1);
    const { gl } = viewer.view, colour = new Uint8Array(4);
    gl.readPixels(gl.drawingBufferWidth / 2, gl.drawingBufferHeight / 2, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, colour);
    return [...colour];
  });
  const before = await middle();
  await move(page, "1. Height", "ArrowRight", 10);
  await move(page, "2. Brightness", "ArrowLeft", 5);
  await move(page, "5. A mixture", "ArrowRight", 20);
  const state = await page.evaluate(() => keys.map((key) => viewer.state[key])), after = await middle();
  check(worst_ratio(state.map((each) => each + 9), [10, 8.5, 9, 9, 11]) < 1e-9, `components: arrow keys move sliders, ${state}`);
  check(before.some((each, i) => Math.abs(each - after[i]) > 5), `components: the sphere changes, ${before} to ${after}`);
  gonio("expand", "--weights", state.join(","), "--in-deviations", "-o", at("five.binary"));
  const { count, off } = await apart_from(page, 0, at("five.binary"));
  check(off < 1e-3, `components: ${count} cells are those of gonio expand --weights ${state}, off by ${(100 * off).toFixed(4)} %`);
}

// The page's errors are those that the lesson shows, which the tests of the documentation compute.
async function check_errors(page) {
  const shown = await page.evaluate(() => [...document.querySelectorAll("tbody tr")].map((row) => [...row.cells].map((cell) => Number(cell.textContent))));
  const lesson = readFileSync(join(repository, "docs/learn/why-twenty.md"), "utf8");
  const printed = lesson.match(/^\d+ +[\d.]+ +[\d.]+$/gm).map((line) => line.split(/ +/).map(Number));
  check(shown.length === 5 && shown.every((row, i) => row.every((each, k) => Math.abs(each - printed[i][k]) < 0.011)), `components: the errors are those of the lesson, ${shown[4]}`);
  const marks = await page.evaluate(() => document.querySelectorAll("svg g[data-mark=dot] > *").length);
  check(marks === 10, `components: the curves have ${marks} points`);
  await move(page, "Components used", "Home", 1);
  await page.locator("[role=status]", { hasText: "With 1 of 100" }).waitFor({ timeout: 300000 });
  const one = await page.evaluate(() => Number(document.querySelector("tbody tr:last-child").cells[1].textContent));
  check(one > 3 * printed[4][1], `components: with one component the error at 20 measurements is ${one}`);
}

async function check_reset(page) {
  await page.locator("label", { hasText: "Start from" }).locator("select").selectOption({ label: "gold-paint" });
  const gold = await page.evaluate(() => [...shown_table.texels.slice(0, 3)]);
  check(gold[0] > 1.1 * gold[2], `components: gold paint is yellow`);
  await page.locator("button", { hasText: "Reset" }).click();
  const [state, grey] = await page.evaluate(() => [keys.map((key) => viewer.state[key]), [...shown_table.texels.slice(0, 3)]]);
  check(state.every((each) => each === 0) && grey[0] === grey[2], "components: reset goes back to the mean");
}

// ---- samples spoiled -------------------------------------------------------------------------------------------
const found = (page) => page.evaluate(() => ({ scan: lesson.scan, spoiled: [...lesson.spoiled], found: lesson.found, now: now(lesson.scan.measured) }));

// Both fits of the page against those of the tool, of the same samples.
async function check_fits(page, what) {
  const { scan, found: fits, now } = await found(page);
  const row = (angle) => [45, 0, -angle, 0];
  writeFileSync(at("scan.csv"), "theta_i,phi_i,theta_o,phi_o,r,g,b\n" + scan.angles.map((angle, i) => [...row(angle), ...now.slice(3 * i, 3 * i + 3)].join(",")).join("\n") + "\n");
  for (const [i, words] of [["--no-reject"], []].entries()) {
    const name = `${what}, ${words.length ? "all count" : "left out"}`, { delta_e, rms, wrong, curve } = fits[i];
    const printed = JSON.parse(gonio("reconstruct", at("scan.csv"), "--noise", "0.02", ...words, "--json", "-o", at("fit.binary"), "--report", at("fit.html")));
    const expected = scan.angles.map(() => 0);
    for (const each of printed.left_out ?? []) expected[each.sample - 1] = each.probability_wrong;
    check(wrong.every((each, k) => Math.abs(each - expected[k]) < 1e-6), `spoil: ${name}: ${(printed.left_out ?? []).map((each) => each.sample)} as gonio reconstruct`);
    const drawn = reported(at("fit.html")).scans[0].curve.filter((each) => Math.abs(each.angle) <= 85).flatMap((each) => each.fit);
    const off = curve.map((each, k) => Math.abs(Math.log(each / drawn[k]))), worst = Math.max(...off);
    check(curve.length === drawn.length && median(off) < 0.002 && worst < 0.1, `spoil: ${name}: the curve is that of gonio report, which reads it off a table: ${(100 * median(off)).toFixed(2)} % apart in the median, ${(100 * worst).toFixed(1)} % at most`);
    const compared = JSON.parse(gonio("compare", at("fit.binary"), at("red.binary"), "--json"));
    const told = compared.delta_e_env;
    check(Math.abs(delta_e / told - 1) < 0.02, `spoil: ${name}: Delta E ${delta_e.toFixed(2)}, the tool's ${told.toFixed(2)}; mapped rms ${rms.toFixed(3)}`);
  }
  return fits;
}

async function check_spoiling(page) {
  gonio("expand", "--formula", "red-paint", "-o", at("red.binary"));
  const clean = await check_fits(page, "clean"), buttons = page.locator("svg [role=button]");
  check(await buttons.count() === 31, "spoil: 31 samples are buttons");
  await buttons.nth(20).click();
  const one = await check_fits(page, "25 degrees spoiled");
  check(one[0].delta_e > 1.5 * clean[0].delta_e && one[1].delta_e < 1.1 * clean[1].delta_e, "spoil: one spoiled sample costs the one fit much and the other nothing");
  check(await page.locator("[role=status]", { hasText: "Left out: 25\u00b0" }).count() === 1, "spoil: the page says which is left out");
  check(await page.evaluate(() => document.querySelectorAll("svg g[data-mark=dot]")[1].childElementCount) === 1, "spoil: and marks it");
  for (let i = 0; i < 4; ++i) await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Enter");
  check((await found(page)).spoiled.join() === "20,24", "spoil: arrow keys and the enter key spoil the one at 45 degrees");
  await check_fits(page, "25 and 45 degrees spoiled");
  await page.keyboard.press("Space");
  check((await found(page)).spoiled.join() === "20", "spoil: the space bar restores it");
  await page.locator("button", { hasText: "Restore all" }).click();
  const back = (await found(page)).found;
  check(back[0].delta_e === clean[0].delta_e && back[1].rms === clean[1].rms, "spoil: restoring all brings back the first fits");
  await check_proposals(page);
}

// What the page says of the samples that it proposes to spoil, and of single ones.
async function check_proposals(page) {
  const left_out_of = (spoiled) => page.evaluate((spoiled) => {
    lesson.spoiled = new Set(spoiled);
    lesson.fit_again(false);
    return left_out(lesson.found[1]);
  }, spoiled);
  const unnoticed = [];
  for (let i = 0; i < 31; ++i) if ((await left_out_of([i])).join() !== String(i)) unnoticed.push(i);
  check(unnoticed.join() === "24", `spoil: of single samples all are noticed but number ${unnoticed}, at 45 degrees`);
  for (const spoiled of [[15, 16, 17], [8, 9, 10, 11]]) {
    const found = await left_out_of(spoiled);
    check(found.sort((a, b) => a - b).join() === spoiled.join(), `spoil: neighbours are found together, and no others: ${found}`);
  }
  const seconds = await page.evaluate(() => {
    const start = performance.now();
    for (let i = 0; i < 10; ++i) lesson.fit_again(false);
    return (performance.now() - start) / 10000;
  });
  console.log(`- spoil: both fits, their tables, errors and the chart take ${(1000 * seconds).toFixed(0)} ms`);
}

// ---- materials to browse -----------------------------------------------------------------------------------------
const sheet_ready = (page) => page.locator("p", { hasText: "Unpacking" }).waitFor({ state: "detached", timeout: 600000 });

async function check_library(page) {
  const lit = await page.evaluate(() => [...document.querySelectorAll(".sheet canvas")].filter((canvas) => {
    const pixels = canvas.getContext("2d").getImageData(0, 0, 96, 96).data;
    return pixels.some((each, i) => i % 4 < 3 && each > 40);
  }).length);
  const names = JSON.parse(gonio("info", join(repository, "examples/data/materials.prior"), "--json")).names;
  const shown = await page.evaluate(() => [...document.querySelectorAll(".sheet span")].map((each) => each.textContent));
  check(lit === names.length && shown.join() === names.join(), `library: all ${lit} materials have a sphere`);
  await page.locator(".sheet button", { hasText: /^gold-paint$/ }).click();
  check(await page.evaluate(() => location.hash === "#gold-paint" && document.querySelector(".halves span").textContent === "gold-paint"), "library: a click shows a material");
  gonio("expand", "--name", "gold-paint", "-o", at("gold.binary"));
  const gold = await apart_from(page, 0, at("gold.binary"));
  check(gold.off < 1e-3, `library: ${gold.count} cells are those of gonio expand, off by ${(100 * gold.off).toFixed(4)} %`);
  gonio("expand", "--formula", "red-paint", "-o", at("red.binary"));
  await page.evaluate(() => {
    Object.assign(viewer.state, { red: 0.42, green: 0.028, blue: 0.022, metal: 0, highlight: 0.04, roughness: 0.15 });
    document.querySelectorAll(".viewer select")[1].dispatchEvent(new Event("input"));
  });
  const model = await apart_from(page, 1, at("red.binary"));
  check(model.off < 1e-3, `library: with its numbers the model is red-paint, off by ${(100 * model.off).toFixed(4)} %`);
  await page.locator(".viewer select").nth(1).selectOption("brass");
  check(await page.locator("svg[aria-label^='Luminance of gold-paint and brass']").count() === 1 && !await page.locator("label", { hasText: "Roughness" }).isVisible(), "library: two materials in one plot, and no sliders of a model");
}

// ---- all ------------------------------------------------------------------------------------------------------
async function check_page(name, ready, act) {
  const file = at(`${name}.html`), size = readFileSync(file).length;
  check(size < 6e6, `${name}: the page has ${(size / 1e6).toFixed(2)} MB`);
  for (const colorScheme of ["light", "dark"]) {
    const { page, complaints, requests } = await open(browser, file, { colorScheme });
    await ready(page);
    await page.waitForTimeout(500);
    await page.screenshot({ path: at(`${name}-${colorScheme}.png`), fullPage: true });
    await check_access(page, `${name}, ${colorScheme}`);
    if (colorScheme === "light") await act(page);
    check(complaints.length === 0, `${name}, ${colorScheme}: the console is empty ${complaints}`);
    check(requests.length === 1, `${name}, ${colorScheme}: no request but the page itself ${requests.slice(1)}`);
    await page.close();
  }
}

await check_page("components", errors_ready, async (page) => {
  await check_errors(page);
  await check_material(page);
  await check_reset(page);
});
await check_page("spoil", (page) => page.waitForSelector("svg [role=button]", { timeout: 60000 }), check_spoiling);
await check_page("library", sheet_ready, check_library);
await browser.close();

const without = await launch("--disable-3d-apis");
const { page } = await open(without, at("components.html"));
await errors_ready(page);
check(await page.locator(".failed", { hasText: "has no WebGL 2" }).count() === 1, "components: without WebGL the page says so, and still computes errors");
await without.close();
finish();
