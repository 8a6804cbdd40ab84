// The viewer against gonio render: ten materials under five lights, pixel by pixel, and what the page's table costs.
import { join } from "node:path";
import { readFileSync, writeFileSync } from "node:fs";
import { inflateSync } from "node:zlib";
import { check, finish, folder, gonio, launch, open, ready, repository } from "./browser.mjs";

const materials = ["chrome", "gold-paint", "blue-rubber", "red-plastic", "pearl-paint", "black-obsidian",
  "white-diffuse-bball", "violet-acrylic", "green-metallic-paint", "paper_red"];
const lights = [[45, 35], [0, 0], [-70, 20], [110, -30], [150, 10]]; // the last two from behind
const size = 256, exposure = 1;

const browser = await launch();
const images = await browser.newPage(); // which reads PNGs

// The pixels of a PNG, less the margin that gonio render draws.
const pixels_of = (file) => images.evaluate(async ([url, side]) => {
  const image = await createImageBitmap(await (await fetch(url)).blob(), { colorSpaceConversion: "none" });
  const canvas = new OffscreenCanvas(side, side), context = canvas.getContext("2d");
  context.drawImage(image, -(image.width - side) / 2, -(image.height - side) / 2);
  return Array.from(context.getImageData(0, 0, side, side).data);
}, [`data:image/png;base64,${readFileSync(file).toString("base64")}`, size]);

// The viewer's pixels from the top, the exposure being that at which a white sphere has the mean luminance 1.
const drawn = (page, [longitude, latitude]) => page.evaluate(([longitude, latitude, side, exposure]) => {
  const { view } = viewer, gl = view.gl, pixels = new Uint8Array(4 * side * side), rows = [];
  view.canvas.width = view.canvas.height = side;
  const mean = white_mean(angle_between(light_direction({ longitude, latitude }), [0, 0, 1]));
  view.draw({ longitude, latitude, shape: "sphere", known: false, exposure: exposure / mean, samples: 3 });
  gl.readPixels(0, 0, side, side, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  for (let row = side - 1; row >= 0; --row) rows.push(...pixels.subarray(4 * side * row, 4 * side * (row + 1)));
  return rows;
}, [longitude, latitude, size, exposure]);

function difference(a, b) {
  let sum = 0, worst = 0, where = 0;
  for (let i = 0; i < a.length; ++i) {
    if (i % 4 === 3) continue;
    const off = Math.abs(a[i] - b[i]);
    sum += off;
    if (off > worst) [worst, where] = [off, i];
  }
  return { mean: sum / (0.75 * a.length), worst, where: [Math.floor(where / 4 / size), Math.floor(where / 4) % size] };
}

const samples_of = (name) => {
  const at = (ending) => join(folder, `${name}${ending}`);
  gonio("expand", "--name", name, "-o", at("-truth.binary"));
  gonio("sample", at("-truth.binary"), "--directions", join(repository, "examples/data/nielsen-20.csv"), "-o", at(".csv"));
  return at;
};

let largest_mean = 0, largest_worst = 0, largest_page = 0;
for (const name of materials) {
  const at = samples_of(name);
  gonio("reconstruct", at(".csv"), "-o", at(".binary"));
  gonio("report", at(".csv"), "-o", at(".html"));
  const { page, complaints } = await open(browser, at(".html"));
  await ready(page);
  largest_page = Math.max(largest_page, readFileSync(at(".html")).length);
  for (const light of lights) {
    gonio("render", at(".binary"), "--size", String(size), `--light=${light}`, "--exposure", String(exposure), "-o", at(".png"));
    const found = difference(await drawn(page, light), await pixels_of(at(".png")));
    largest_mean = Math.max(largest_mean, found.mean);
    largest_worst = Math.max(largest_worst, found.worst);
    console.log(`${name}, light at ${light}: mean difference ${found.mean.toFixed(3)}/255, worst ${found.worst}/255 at ${found.where}`);
  }
  if (complaints.length) check(false, `${name}: ${complaints}`);
  await page.close();
}
check(largest_mean < 1, `mean difference to gonio render at most ${largest_mean.toFixed(3)}/255`);
check(largest_worst < 6, `worst difference to gonio render ${largest_worst}/255`);
check(largest_page < 4e6, `pages of at most ${(largest_page / 1e6).toFixed(2)} MB`);
await browser.close();
finish();
