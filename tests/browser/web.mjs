// The engine of the page in Node: the same fabrics.csv as the command's, to the last byte.
//
//     node web.mjs KESF.HTML FABRICS.CSV FOLDER
//
// FABRICS.CSV is what `kesf run FOLDER` wrote. The last line is `N passed, N failed`.
import { readFileSync, readdirSync, statSync } from "node:fs";
import { join, relative } from "node:path";
import vm from "node:vm";

const [page, expected, folder] = process.argv.slice(2);
const html = readFileSync(page, "utf8");
const part = (id) => html.split(`<script type="text/plain" id="${id}">`)[1].split("</script>")[0];

// What a worker has of a browser.
const answers = [];
const scope = vm.createContext({
  TextDecoder, TextEncoder, WebAssembly, FinalizationRegistry, Uint8Array, URL, console, performance,
  addEventListener() {},
  postMessage: (message) => answers.push(message),
});
vm.runInContext(part("worker-text") + "\n;globalThis.ANSWERS = ANSWERS; globalThis.ENGINE = kesf_web;", scope);

const files = (at) => readdirSync(at).flatMap((name) => {
  const path = join(at, name);
  return statSync(path).isDirectory() ? files(path) : [path];
});
const dropped = files(folder).map((path) => {
  const bytes = readFileSync(path);
  const copy = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  return { path: join("kesf_data", relative(folder, path)), file: { arrayBuffer: async () => copy } };
});
const raw = (id) => new Uint8Array(Buffer.from(part(id), "base64"));
const gunzipped = (await import("node:zlib")).gunzipSync(raw("unpack"));
scope.ANSWERS.begin({ unpack: new Uint8Array(gunzipped), packed: raw("engine") });
const form = { settings: "", dialect: "", assume_kes_units: false, cases: false };
await scope.ANSWERS.work({ job: 1, form, files: dropped, example: false, loose: "fabric" });

const lines = (text) => text.trimEnd().split("\n");
const found = lines(new TextDecoder().decode(scope.ENGINE.read("fabrics.csv")));
const wanted = lines(readFileSync(expected, "utf8"));
const differing = wanted.filter((line, i) => line !== found[i]);
const failed = Number(differing.length > 0 || found.length !== wanted.length || wanted.length < 100);
if (failed) console.log(`FAILED: ${found.length} of ${wanted.length} lines, ${differing.length} differ: ${differing[0]}`, answers.at(-1));
console.log(`${1 - failed} passed, ${failed} failed`);
process.exit(failed);
