// SPDX-License-Identifier: MIT
// Makes the page: `node build.mjs OUT`. Every file in OUT is gzipped, as it goes into the program.
import { Buffer } from "node:buffer";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { basename } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import esbuild from "esbuild";

const MOST_BYTES = 250e3;
const here = fileURLToPath(new URL(".", import.meta.url));
const out = process.argv[2] ?? `${here}../build/page`;

const bundled = await esbuild.build({
  absWorkingDir: here,
  entryPoints: { page: "src/main.tsx", map_worker: "src/map/map_worker.ts" },
  outdir: out,
  bundle: true,
  minify: true,
  write: false,
  format: "iife",
  target: ["chrome94", "firefox100", "safari15.4"],
  jsx: "automatic",
  jsxImportSource: "preact",
  loader: { ".png": "dataurl", "": "text" }, // "": licences
  legalComments: "none",
  charset: "utf8",
  logLevel: "warning",
});

const files = bundled.outputFiles.map((file) => [basename(file.path), Buffer.from(file.contents)]);
for (const name of ["index.html", "manifest.webmanifest", "icon.svg", "icon-192.png", "icon-512.png"])
  files.push([name, readFileSync(`${here}static/${name}`)]);

rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
let total = 0;
for (const [name, bytes] of files) {
  const packed = gzipSync(bytes, { level: 9 });
  packed[9] = 3; // else the operating system's number makes the same page differ from machine to machine
  writeFileSync(`${out}/${name}`, packed);
  total += packed.length;
}
console.log(`page: ${files.length} files, ${(total / 1e3).toFixed(1)} kB compressed`);
if (total > MOST_BYTES) {
  console.error(`the page may have at most ${MOST_BYTES / 1e3} kB`);
  process.exit(1);
}
