#!/usr/bin/env node
// The viewer's light from all around against gonio render --environment: materials in the page's own sky.
import { join } from "node:path";
import { readFileSync, writeFileSync } from "node:fs";
import { check, finish, folder, gonio, launch, open, ready, repository } from "./browser.mjs";

const materials = ["paper_red", "blue-rubber", "red-plastic"], size = 128, frames = 256, limit = 2;
const browser = await launch();
const images = await browser.newPage(); // which reads PNGs

// The pixels of a PNG, less the margin that gonio render draws.
const pixels_of = (file) => images.evaluate(async ([url, side]) => {
  const image = await createImageBitmap(await (await fetch(url)).blob(), { colorSpaceConversion: "none" });
  const canvas = new OffscreenCanvas(side, side), context = canvas.getContext("2d");
  context.drawImage(image, -(image.width - side) / 2, -(image.height - side) / 2);
  return Array.from(context.getImageData(0, 0, side, side).data);
}, [`data:image/png;base64,${readFileSync(file).toString("base64")}`, size]);

// The page's sky as an unpacked Radiance picture.
async function write_sky(page, file) {
  const { rows, columns, radiance } = await page.evaluate(() => {
    const sky = formula_sky();
    return { ...sky, radiance: Array.from(sky.radiance) };
  });
  const pixels = Buffer.alloc(4 * rows * columns);
  for (let i = 0; i < rows * columns; ++i) {
    const rgb = radiance.slice(3 * i, 3 * i + 3), exponent = Math.floor(Math.log2(Math.max(...rgb))) + 1;
    rgb.forEach((each, k) => { pixels[4 * i + k] = Math.floor(each * 2 ** (8 - exponent)); });
    pixels[4 * i + 3] = exponent + 128;
  }
  writeFileSync(file, Buffer.concat([Buffer.from(`#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${rows} +X ${columns}\n`), pixels]));
}

// The viewer's pixels from the top after so many frames.
const drawn = (page, hdr) => page.evaluate(([base64, side, frames]) => {
  const { view } = viewer, gl = view.gl, pixels = new Uint8Array(4 * side * side), rows = [];
  view.canvas.width = view.canvas.height = side;
  viewer.surrounded ??= new surrounded_view(view);
  viewer.surrounded.take(read_hdr(Uint8Array.from(atob(base64), (each) => each.charCodeAt(0))));
  for (let i = 0; i < frames; ++i)
    viewer.surrounded.draw({ longitude: 0, latitude: 0, shape: "sphere", known: false, exposure: 0.4 });
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  for (let row = side - 1; row >= 0; --row) rows.push(...pixels.subarray(4 * side * row, 4 * side * (row + 1)));
  return rows;
}, [readFileSync(hdr).toString("base64"), size, frames]);

// Means of 4 x 4 pixels, which smooths the noise of both.
function smoothed(pixels) {
  const side = size / 4, sums = new Float64Array(3 * side * side);
  for (let y = 0; y < size; ++y)
    for (let x = 0; x < size; ++x)
      for (let k = 0; k < 3; ++k) sums[3 * (Math.floor(y / 4) * side + Math.floor(x / 4)) + k] += pixels[4 * (y * size + x) + k] / 16;
  return sums;
}
const inner = smoothed(Array.from({ length: 4 * size * size }, (_, i) => {
  const at = Math.floor(i / 4), x = (at % size + 0.5) / size * 2 - 1, y = (Math.floor(at / size) + 0.5) / size * 2 - 1;
  return x * x + y * y < 1 ? 1 : 0;
})); // 1 where all sixteen pixels are of the sphere, beside which gonio render shows the environment or grey
function difference(a, b) {
  let sum = 0, count = 0;
  for (let i = 0; i < a.length; ++i) if (inner[i] > 0.999) { sum += Math.abs(a[i] - b[i]); ++count; }
  return (sum / count).toFixed(3);
}

console.log("| material | mean difference, of 255 | two runs of the viewer | two seeds of gonio render |\n| --- | --- | --- | --- |");
for (const name of materials) {
  const at = (ending) => join(folder, `${name}${ending}`), hdr = join(folder, "sky.hdr");
  gonio("expand", "--name", name, "-o", at("-truth.binary"));
  gonio("sample", at("-truth.binary"), "--directions", join(repository, "examples/data/nielsen-20.csv"), "-o", at(".csv"));
  gonio("reconstruct", at(".csv"), "-o", at(".binary"));
  gonio("report", at(".csv"), "-o", at(".html"));
  const { page, complaints } = await open(browser, at(".html"));
  await ready(page);
  await write_sky(page, hdr);
  const render = async (seed) => {
    gonio("render", at(".binary"), "--environment", hdr, "--quality", "256", "--size", String(size), "--seed", seed, "-o", at(".png"));
    return smoothed(await pixels_of(at(".png")));
  };
  const theirs = [await render("1"), await render("2")], ours = [smoothed(await drawn(page, hdr)), smoothed(await drawn(page, hdr))];
  const found = difference(ours[0], theirs[0]);
  console.log(`| ${name} | ${found} | ${difference(...ours)} | ${difference(...theirs)} |`);
  const told = await page.evaluate(() => {
    const bytes = (text) => new TextEncoder().encode(text), of = (text) => { try { read_hdr(bytes(text)); return "read"; } catch (e) { return e.message; } };
    return [of("#?RADIANCE\n\n-Y 2 +X 4\nabc"), of("#?RADIANCE\n\n-Y 9999 +X 19998\n"), of("#?RADIANCE\n\n-Y 2 +X 5\n"), of("P6\n")];
  });
  check(Number(found) < limit, `${name}: below ${limit}/255`);
  check(/ends before/.test(told[0]) && /more than/.test(told[1]) && /twice/.test(told[2]) && /begin/.test(told[3]), "files that are no light probes are refused");
  check(complaints.length === 0, `${name}: no complaints ${complaints}`);
  if (name === materials[2]) {
    for (const scheme of ["light", "dark"]) {
      await page.emulateMedia({ colorScheme: scheme });
      await page.evaluate(() => { viewer.view.canvas.width = viewer.view.canvas.height = 256; });
      await page.locator("select:has(option[value=environment])").selectOption("lamp");
      await page.locator("select:has(option[value=environment])").selectOption("environment");
      await page.waitForFunction(() => viewer.surrounded.frame >= 32, null, { timeout: 60000 });
      await page.locator(".viewer").screenshot({ path: join(folder, `${scheme}.png`) });
    }
  }
  await page.close();
}
await browser.close();
finish();
