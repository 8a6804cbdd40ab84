// What the tests in a browser share: chromium without a window, WebGL in software, and pages of gonio report.
// Exit code 77 means that something is not installed, and that nothing was tested.
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

export const repository = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const executablePath = process.env.GONIO_CHROMIUM ?? "/usr/bin/chromium";
const [given_tool, given_folder] = process.argv.slice(2);
if (!given_tool || !given_folder) throw new Error("usage: node page.mjs TOOL FOLDER");
export const tool = given_tool, folder = resolve(given_folder);
mkdirSync(folder, { recursive: true });

export function skip(reason) {
  console.log(`skipped: ${reason}`);
  process.exit(77);
}

export function gonio(...words) {
  return execFileSync(tool, words, { encoding: "utf8", stdio: ["ignore", "pipe", "ignore"] });
}

export async function launch(...more) {
  const { chromium } = await import("playwright-core").catch(() => skip("npm ci in examples/report installs playwright-core"));
  if (!existsSync(executablePath)) skip(`there is no ${executablePath}; GONIO_CHROMIUM names another`);
  return chromium.launch({ executablePath, args: more.length ? more : ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
}

// A page, and what it complained of and asked for.
export async function open(browser, file, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1200, height: 900 }, ...options });
  page.setDefaultTimeout(180000); // a busy machine draws by software for a minute
  const complaints = [], requests = [];
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) complaints.push(message.text()); });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => { if (!/^(data|blob):/.test(request.url())) requests.push(request.url()); });
  await page.goto(`file://${file}`);
  return { page, complaints, requests };
}

// Until the viewer has drawn, or says that it cannot.
export const ready = (page) => page.waitForSelector(".viewer, .no-viewer");

// How many images of so many rows and columns the viewer draws in a second.
export async function frames_a_second(page, size) {
  return page.evaluate((size) => {
    viewer.view.canvas.width = viewer.view.canvas.height = size;
    const { view } = viewer, gl = view.gl, pixel = new Uint8Array(4), frames = 40, start = performance.now();
    for (let i = 0; i < frames; ++i) {
      view.draw({ ...viewer.state, longitude: 9 * i - 180, exposure: 1, samples: 1 });
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // which waits for the drawing
    }
    return 1000 * frames / (performance.now() - start);
  }, size);
}

// What reads the pixels of a PNG that gonio render drew, less its margin: red, green, blue and 255, from the top.
export async function png_reader(browser, size) {
  const images = await browser.newPage();
  return (file) => images.evaluate(async ([url, side]) => {
    const image = await createImageBitmap(await (await fetch(url)).blob(), { colorSpaceConversion: "none" });
    const canvas = new OffscreenCanvas(side, side), context = canvas.getContext("2d");
    context.drawImage(image, -(image.width - side) / 2, -(image.height - side) / 2);
    return Array.from(context.getImageData(0, 0, side, side).data);
  }, [`data:image/png;base64,${readFileSync(file).toString("base64")}`, size]);
}

// Of the pixels of two images: magnitudes and signs in the mean over three channels, and the largest magnitude.
export function difference(a, b) {
  let sum = 0, bias = 0, worst = 0;
  for (let i = 0; i < a.length; ++i) {
    sum += Math.abs(a[i] - b[i]);
    bias += a[i] - b[i];
    worst = Math.max(worst, Math.abs(a[i] - b[i]));
  }
  const count = 0.75 * a.length; // the fourth channel has no differences
  return { mean: sum / count, bias: bias / count, worst };
}

// Writes the table of a material of the prior and 20 samples of it; returns what names files of the material.
export function samples_of(name) {
  const at = (ending) => join(folder, `${name}${ending}`);
  gonio("expand", "--name", name, "-o", at("-truth.binary"));
  gonio("sample", at("-truth.binary"), "--directions", join(repository, "examples/data/nielsen-20.csv"), "-o", at(".csv"));
  return at;
}

// A row of a table in Markdown.
export const row = (...fields) => console.log(`| ${fields.join(" | ")} |`);

let failures = 0;
export function check(holds, what) {
  if (!holds) ++failures;
  console.log(`- ${holds ? "ok" : "FAILED"}: ${what}`);
}
export function finish() {
  if (failures) console.log(`${failures} checks failed`);
  process.exit(failures ? 1 : 0);
}

// What axe finds in a part of a page.
const axe = () => readFileSync(createRequire(import.meta.url).resolve("axe-core"), "utf8");
export async function check_access(page, name, part = "html") {
  await page.addScriptTag({ content: axe() });
  const { violations, passes } = await page.evaluate((part) => window.axe.run(part), part);
  check(violations.length === 0, `${name}: axe finds ${violations.length} violations of ${passes.length + violations.length} rules`);
  for (const each of violations) console.log(`  ${each.id}: ${each.help}: ${each.nodes[0].html.slice(0, 200)}`);
}
