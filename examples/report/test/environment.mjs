#!/usr/bin/env node
// The viewer in an environment against gonio render --environment: materials in the page's own room, and in the light
// probe of a third argument. What either of both is uncertain by, which is noise, stands beside their difference.
import { join } from "node:path";
import { readFileSync, writeFileSync } from "node:fs";
import { check, difference, finish, folder, gonio, launch, open, png_reader, ready, row, samples_of } from "./browser.mjs";

const probe = process.argv[4];
const materials = ["paper_red", "blue-rubber", "red-plastic", "chrome"], size = 128, frames = 256;
const browser = await launch();
const pixels_of = await png_reader(browser, size);

// The page's room as a Radiance picture that is not packed.
async function write_room(page, file) {
  const { rows, columns, radiance } = await page.evaluate(() => {
    const room = room_with_windows();
    return { ...room, radiance: Array.from(room.radiance) };
  });
  const pixels = Buffer.alloc(4 * rows * columns);
  for (let i = 0; i < rows * columns; ++i) {
    const rgb = radiance.slice(3 * i, 3 * i + 3), exponent = Math.floor(Math.log2(Math.max(...rgb))) + 1;
    rgb.forEach((each, k) => { pixels[4 * i + k] = Math.floor(each * 2 ** (8 - exponent)); });
    pixels[4 * i + 3] = exponent + 128;
  }
  writeFileSync(file, Buffer.concat([Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${rows} +X ${columns}\n`), pixels]));
}

// Puts the viewer into an environment, at the size of this test.
const surround = (page, hdr) => page.evaluate(async ([base64, side]) => {
  const { view } = viewer, choice = document.querySelector("select:has(option[value=environment])");
  view.canvas.width = view.canvas.height = side;
  choice.value = "environment";
  choice.dispatchEvent(new Event("input"));
  viewer.state.light = "lamp"; // which stops the page's own frames
  viewer.surrounded.take(read_hdr(Uint8Array.from(atob(base64), (each) => each.charCodeAt(0))));
}, [readFileSync(hdr).toString("base64"), size]);

// The viewer's pixels from the top after half of the frames, and after all.
const drawn = (page) => page.evaluate(async ([side, frames]) => {
  const { view, surrounded } = viewer, gl = view.gl, pixels = new Uint8Array(4 * side * side), results = [];
  surrounded.frame = 0;
  while (surrounded.frame < frames) {
    surrounded.draw({ longitude: 0, latitude: 0, around: 0, shape: "sphere", known: false, exposure: 0.4 });
    if (surrounded.frame % (frames / 2) !== 0) continue;
    gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const rows = [];
    for (let row = side - 1; row >= 0; --row) rows.push(...pixels.subarray(4 * side * row, 4 * side * (row + 1)));
    results.push(rows);
  }
  return results;
}, [size, frames]);

// Means of 4 x 4 pixels.
function smoothed(pixels) {
  const side = size / 4, sums = new Float64Array(4 * side * side);
  pixels.forEach((value, i) => {
    const x = (i >> 2) % size, y = Math.floor((i >> 2) / size);
    sums[4 * (Math.floor(y / 4) * side + Math.floor(x / 4)) + i % 4] += value / 16;
  });
  return sums;
}

async function judge(page, name, light, hdr, table) {
  const render = async (seed) => {
    const file = join(folder, `${name}-${light}.png`);
    gonio("render", table, "--environment", hdr, "--quality", "256", "--size", String(size), "--seed", seed, "-o", file);
    return pixels_of(file);
  };
  await surround(page, hdr);
  const theirs = [await render("1"), await render("2")], [half, ours] = await drawn(page);
  const { mean, bias } = difference(ours, theirs[0]);
  const [worst, worst_of_theirs] = [ours, theirs[1]].map((each) => difference(smoothed(each), smoothed(theirs[0])).worst);
  const noise = [Math.SQRT2 * difference(ours, half).mean, difference(...theirs).mean]; // of two runs each
  row(name, light, mean.toFixed(3), bias.toFixed(3), worst.toFixed(2), worst_of_theirs.toFixed(2), ...noise.map((each) => each.toFixed(3)));
  return { mean, bias: Math.abs(bias), worst: worst - worst_of_theirs, noise };
}

const is_refused = (page, text) => page.evaluate((text) => {
  try { read_hdr(new TextEncoder().encode(text)); } catch (error) { return error.message; }
  return "";
}, text);

row("material", "light", "mean difference, of 255", "with its sign", "worst of 4 x 4 pixels' means", "of two seeds of gonio render", "noise of the viewer", "of gonio render");
row(...Array(8).fill("---"));
const found = [];
for (const name of materials) {
  const at = samples_of(name), room = join(folder, "room.hdr");
  gonio("reconstruct", at(".csv"), "-o", at(".binary"));
  gonio("report", at(".csv"), "-o", at(".html"));
  const { page, complaints } = await open(browser, at(".html"));
  await ready(page);
  await write_room(page, room);
  found.push(await judge(page, name, "room", room, at(".binary")));
  if (probe) found.push(await judge(page, name, "light probe", probe, at(".binary")));
  if (complaints.length) check(false, `${name}: ${complaints}`);
  if (name === materials[0]) {
    const refused = [["#?RADIANCE\n\n-Y 2 +X 4\nabc", "ends before"], ["#?RADIANCE\n\n-Y 9999 +X 19998\n", "more than"],
      ["#?RADIANCE\n\n-Y 2 +X 5\n", "twice"], ["P6\n", "begin"], ["#?RADIANCE\n\n-Y 1 +X 2\n" + "\0".repeat(8), "black"]];
    for (const [text, why] of refused) if (!(await is_refused(page, text)).includes(why)) check(false, `a file that ${why} is refused`);
  }
  await page.close();
}
await browser.close();
console.log("");
const largest = (key) => Math.max(...found.map((each) => each[key]));
check(largest("bias") < 0.1, "the viewer's mean difference to gonio render with its sign is below 0.1/255");
check(found.every((each) => each.mean < 0.05 + Math.hypot(...each.noise) / Math.SQRT2), "the mean difference is that of the noise of both");
check(largest("worst") < 2, "means of 4 x 4 pixels are nowhere 2/255 further apart than with two seeds of gonio render");
check(Math.max(...found.map((each) => each.noise[0])) < 2, "the noise of the viewer is below 2/255");
finish();
