// npm run bundle: writes bundle.js, the parts of Observable Plot and D3 that report.js needs, and bundle.LICENSE.txt,
// their licences. bundle.js begins with the licences: they require it, and every page contains the bundle.
import { build } from "esbuild";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";

const { metafile } = await build({
  entryPoints: ["plot.js"], bundle: true, minify: true, format: "iife", globalName: "Plot", target: "es2020",
  charset: "ascii", legalComments: "none", outfile: "bundle.js", metafile: true,
});
const inputs = Object.entries(Object.values(metafile.outputs)[0].inputs).filter(([, part]) => part.bytesInOutput > 0);
const packages = new Set(inputs.map(([file]) => file.match(/^node_modules\/((?:@[^/]+\/)?[^/]+)/)?.[1]).filter(Boolean));
const licences = [...packages].sort().map((name) => {
  const folder = `node_modules/${name}`;
  const { version, license } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
  const file = readdirSync(folder).find((each) => /^licen[cs]e/i.test(each));
  return `${name} ${version} (${license})\n\n${file ? readFileSync(`${folder}/${file}`, "utf8").trim() : "no licence file"}\n`;
});
const text = licences.join("\n" + "-".repeat(80) + "\n\n");
if (text.includes("*/") || text.includes("</")) throw new Error("the licences cannot stand in a comment of a page");
writeFileSync("bundle.LICENSE.txt", text);
writeFileSync("bundle.js", `/*!\n${text}*/\n${readFileSync("bundle.js", "utf8")}`);
