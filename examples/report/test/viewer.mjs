#!/usr/bin/env node
// The viewer against gonio render: ten materials under five lights, pixel by pixel, and what the page's table costs.
import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { inflateSync } from "node:zlib";
import { check, difference, finish, frames_a_second, gonio, launch, open, png_reader, ready, row, samples_of } from "./browser.mjs";

const materials = ["chrome", "gold-paint", "blue-rubber", "red-plastic", "pearl-paint", "black-obsidian",
  "white-diffuse-bball", "violet-acrylic", "green-metallic-paint", "paper_red"];
const lights = [[45, 35], [0, 0], [-70, 20], [110, -30], [150, 10]]; // the last two from behind
const size = 256, exposure = 0.5;

const browser = await launch();
const pixels_of = await png_reader(browser, size);

// The viewer's pixels from the top, the exposure being that at which a white sphere has the mean luminance 1.
const drawn = (page, [longitude, latitude], truth = 0) => page.evaluate(([longitude, latitude, side, exposure, truth]) => {
  const { view } = viewer, gl = view.gl, pixels = new Uint8Array(4 * side * side), rows = [];
  view.canvas.width = view.canvas.height = side;
  const mean = white_mean(angle_between(light_direction({ longitude, latitude }), [0, 0, 1]));
  view.draw({ longitude, latitude, shape: "sphere", known: false, exposure: exposure / mean, samples: 3, truth });
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  for (let row = side - 1; row >= 0; --row) rows.push(...pixels.subarray(4 * side * row, 4 * side * (row + 1)));
  return rows;
}, [longitude, latitude, size, exposure, truth]);

// The page's table as a file that gonio compare reads: the values of `like` are replaced.
function write_table(page_file, like, file) {
  const html = readFileSync(page_file, "utf8"), opening = '<script id="data" type="application/json">';
  const start = html.indexOf(opening) + opening.length;
  const { table } = JSON.parse(html.slice(start, html.indexOf("</script>", start))).viewer;
  const bytes = inflateSync(Buffer.from(table.codes, "base64")), count = 3 * table.cells, merl = readFileSync(like);
  for (let channel = 0, i = 0, at = 12; channel < 3; ++channel)
    for (let cell = 0, code = 0; cell < table.grid[0] * table.grid[1] * table.grid[2]; ++cell, at += 8) {
      if (merl.readDoubleLE(at) < 0) continue;
      const folded = bytes[i] + 256 * bytes[count + i++];
      code += folded & 1 ? -(folded + 1) / 2 : folded / 2;
      const exponent = code >> 8, fraction = (code & 255) / 256;
      const half = exponent === 0 ? fraction * 2 ** -14 : (1 + fraction) * 2 ** (exponent - 15);
      merl.writeDoubleLE(half * table.scale * [1500, 1500 / 1.15, 1500 / 1.66][channel], at);
    }
  writeFileSync(file, merl);
}

// The worst of five lights, and what the page's table costs under two lights and in an environment.
async function judge(name) {
  const at = samples_of(name), worst = { mean: 0, worst: 0 };
  gonio("reconstruct", at(".csv"), "-o", at(".binary"));
  gonio("report", at(".csv"), "-o", at(".html"));
  const { page, complaints } = await open(browser, at(".html"));
  await ready(page);
  for (const light of lights) {
    gonio("render", at(".binary"), "--size", String(size), `--light=${light}`, "--exposure", String(exposure), "-o", at(".png"));
    const found = difference(await drawn(page, light), await pixels_of(at(".png")));
    worst.mean = Math.max(worst.mean, found.mean);
    worst.worst = Math.max(worst.worst, found.worst);
  }
  const frames = [await frames_a_second(page, 256), await frames_a_second(page, 512)];
  await page.close();
  write_table(at(".html"), at(".binary"), at("-page.binary"));
  const costs = JSON.parse(gonio("compare", at("-page.binary"), at(".binary"), "--json"));
  const megabytes = readFileSync(at(".html")).length / 1e6;
  for (const file of [".binary", "-truth.binary", "-page.binary"]) rmSync(at(file));
  if (complaints.length) check(false, `${name}: ${complaints}`);
  return { ...worst, delta_e: Math.max(costs.delta_e_lights, costs.delta_e_env), megabytes, frames };
}

// The truth beside the fit: what --truth adds to the page, and whether all of it is drawn.
async function judge_truth(name) {
  const at = samples_of(name), light = lights[0];
  gonio("report", at(".csv"), "--truth", at("-truth.binary"), "-o", at(".html"));
  gonio("render", at("-truth.binary"), "--size", String(size), `--light=${light}`, "--exposure", String(exposure), "-o", at(".png"));
  const { page } = await open(browser, at(".html"));
  await ready(page);
  const found = difference(await drawn(page, light, 101), await pixels_of(at(".png")));
  const megabytes = readFileSync(at(".html")).length / 1e6;
  check(found.worst < 6, `${name}, the truth beside the fit: worst difference ${found.worst}/255`);
  check(megabytes < 4, `${name}, the truth beside the fit: a page of ${megabytes.toFixed(2)} MB`);
  await page.close();
}

row("material", "mean difference, of 255", "worst, of 255", "Delta E of the page's table", "page, MB", "frames a second, 256 x 256", "512 x 512");
row(...Array(7).fill("---"));
const all = [];
for (const name of materials) {
  const found = await judge(name);
  row(name, found.mean.toFixed(3), String(found.worst), found.delta_e.toFixed(3), found.megabytes.toFixed(2), ...found.frames.map((each) => each.toFixed(0)));
  all.push(found);
}
console.log("");
const largest = (key) => Math.max(...all.map((each) => each[key]));
check(largest("mean") < 1, "the viewer's mean difference to gonio render is below 1/255");
check(largest("worst") < 6, "its worst difference is below 6/255");
check(largest("delta_e") < 0.1, "the page's table costs less than 0.1 Delta E");
check(largest("megabytes") < 4, "the page has less than 4 MB");
await judge_truth("paper_red");
await browser.close();
finish();
