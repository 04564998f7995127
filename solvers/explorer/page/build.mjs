// Bundles the page and its worker into ../built, with the digest of what they are built from. `npm ci && npm run build`
import { build } from "esbuild-wasm";
import { createHash } from "node:crypto";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";

const target = process.argv[2] ?? "../built";
await build({
  entryPoints: { page: "main.ts", worker: "worker.ts" },
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "inline",
  outdir: target,
});
const sources = readdirSync(".").filter((name) => /\.(ts|css|json|mjs)$/.test(name)).sort();
const hash = createHash("sha256");
for (const name of sources) hash.update(`${name}\0`).update(readFileSync(name)).update("\0");
for (const name of ["page.css", "page.js", "worker.js"]) hash.update(`${name}\0`).update(readFileSync(`${target}/${name}`)).update("\0");
writeFileSync(`${target}/DIGEST`, `${hash.digest("hex")}\n`);
