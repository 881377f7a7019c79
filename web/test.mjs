// SPDX-License-Identifier: MIT
// Runs the tests of the page's pure code, which are in tests/web/unit.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { fileURLToPath } from "node:url";
import esbuild from "esbuild";

const here = fileURLToPath(new URL(".", import.meta.url));
const tests = `${here}../tests/web/unit/`;
const out = mkdtempSync(`${tmpdir()}/dynslam-page-`);
await esbuild.build({
  entryPoints: readdirSync(tests).filter((name) => name.endsWith(".test.ts")).map((name) => tests + name),
  outdir: out,
  outExtension: { ".js": ".mjs" },
  bundle: true,
  platform: "node",
  format: "esm",
  nodePaths: [`${here}node_modules`],
  logLevel: "warning",
});
const run = spawnSync("node", ["--test", out], { stdio: "inherit", env: { ...process.env, GOLDEN: `${here}golden` } });
rmSync(out, { recursive: true });
process.exit(run.status ?? 1);
