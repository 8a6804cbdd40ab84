// Draws the images of docs/learn that replace the site's interactive pages on paper and on GitHub:
//   cmake -D OUTPUT=FOLDER -P cmake/lessons.cmake && node examples/lessons/pictures.mjs TOOL FOLDER
// writes lesson-*.png to FOLDER. Needs chromium, and npm ci in examples/report.
import { join } from "node:path";
import { folder, gonio, launch, open, ready, repository } from "../report/test/browser.mjs";

const at = (name) => join(folder, name);
const browser = await launch();

// Opens the report of a material, measured as on the site.
async function open_report(name) {
  gonio("expand", "--name", name, "-o", at("truth.binary"));
  gonio("sample", at("truth.binary"), "--directions", join(repository, "examples/data/nielsen-20.csv"), "--noise", "0.02", "-o", at("samples.csv"));
  gonio("report", at("samples.csv"), "--noise", "0.02", "--truth", at("truth.binary"), "--title", name, "-o", at(`${name}.html`));
  const { page } = await open(browser, at(`${name}.html`), { colorScheme: "light" });
  await ready(page);
  return page;
}

// Returns the viewer's image with its labels, for another state of its controls.
async function image_of(page, state) {
  await page.evaluate((state) => {
    Object.assign(viewer.state, state);
    document.querySelector(".viewer input[type=range]").dispatchEvent(new Event("input")); // which draws again
    Object.assign(viewer.state, state); // the event took the slider's value
  }, state);
  await page.waitForTimeout(1500); // until nine samples a pixel are drawn
  return `data:image/png;base64,${(await page.locator(".viewer .image").screenshot()).toString("base64")}`;
}

// Writes images in a row, each with a caption.
async function write_row(name, shown) {
  const page = await browser.newPage({ viewport: { width: 320 * shown.length, height: 600 }, colorScheme: "light" });
  const figures = shown.map(([image, text]) => `<figure><img src="${image}" width="300"><figcaption>${text}</figcaption></figure>`);
  await page.setContent(`<style>body { margin: 0; font: 15px "DejaVu Sans", sans-serif; background: #fff }
    main { display: flex; gap: 10px; width: fit-content; padding: 5px } figure { margin: 0; width: 300px } img { border-radius: 8px; display: block }</style>
    <main>${figures.join("")}</main>`);
  await page.locator("main").screenshot({ path: at(name) });
}

const plastic = await open_report("red-plastic");
await plastic.addStyleTag({ content: ".halves { visibility: hidden }" });
await write_row("lesson-brdf.png", [
  [await image_of(plastic, { truth: 100, longitude: 0, latitude: 0 }), "light from the camera"],
  [await image_of(plastic, { longitude: 45, latitude: 35 }), "45° to the right, 35° up"],
  [await image_of(plastic, { longitude: 120, latitude: 35 }), "120°: from behind, the rim shines"],
]);
const gold = await open_report("gold-paint");
await write_row("lesson-twenty.png", [
  [await image_of(gold, { truth: 50 }), "20 samples, and the truth"],
  [await image_of(gold, { truth: 0, known: true }), "how well known: light to 2 %, dark to 100 %"],
]);

// Writes an image of a part of an interactive page, after its computation and a change.
async function write_part(name, file, part, wait, change) {
  const { page } = await open(browser, at(file), { colorScheme: "light", viewport: { width: 900, height: 900 } });
  await wait(page);
  await change(page);
  await page.waitForTimeout(1000);
  const box = await page.evaluate((part) => {
    const boxes = [...document.querySelectorAll(part)].map((each) => each.getBoundingClientRect());
    const top = Math.min(...boxes.map((each) => each.top + scrollY)), bottom = Math.max(...boxes.map((each) => each.bottom + scrollY));
    return { x: 0, y: Math.max(0, top - 8), width: innerWidth, height: bottom - top + 16 };
  }, part);
  await page.screenshot({ path: at(name), fullPage: true, clip: box });
}
await write_part("lesson-components.png", "components.html", "section h2, .viewer, figure",
  (page) => page.locator("[role=status]", { hasText: "of 100 components" }).waitFor({ timeout: 120000 }),
  (page) => page.evaluate(() => {
    const start = document.querySelector(".viewer select");
    start.selectedIndex = [...start.options].findIndex((each) => each.text === "gold-paint");
    start.dispatchEvent(new Event("input"));
  }));
await write_part("lesson-library.png", "library.html", "section:first-of-type, .sheet button:nth-child(-n+16)",
  (page) => page.locator("p", { hasText: "Unpacking" }).waitFor({ state: "detached", timeout: 600000 }),
  (page) => page.locator(".sheet button", { hasText: /^gold-paint$/ }).click());
await write_part("lesson-spoil.png", "spoil.html", ".curves, figure, [role=status]",
  (page) => page.waitForSelector("svg [role=button]", { timeout: 120000 }),
  (page) => page.locator("svg [role=button]").nth(20).click());
await browser.close();
