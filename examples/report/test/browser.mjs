// What the tests in a browser share: chromium without a window, WebGL in software, and pages of gonio report.
// Exit code 77 means that something is not installed, and that nothing was tested.
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync } from "node:fs";
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

let failures = 0;
export function check(holds, what) {
  if (!holds) ++failures;
  console.log(`- ${holds ? "ok" : "FAILED"}: ${what}`);
}
export function finish() {
  if (failures) console.log(`${failures} checks failed`);
  process.exit(failures ? 1 : 0);
}
