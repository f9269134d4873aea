// Khronos' validator on every GLB: node validate.mjs FOLDER…
import fs from "node:fs";
import validator from "gltf-validator";
import { fail, filesOf } from "./files.mjs";

const checked = async (bytes) => (await validator.validateBytes(new Uint8Array(bytes))).issues;

for (const folder of process.argv.slice(2)) {
  const counts = { files: 0, errors: 0, warnings: 0 };
  for (const file of filesOf(folder, ".glb")) {
    const issues = await checked(fs.readFileSync(file));
    counts.files += 1;
    counts.errors += issues.numErrors;
    counts.warnings += issues.numWarnings;
    if (issues.numErrors) fail(`${file}: ${JSON.stringify(issues.messages[0])}`);
  }
  console.log("glTF validator", folder, counts);
  if (counts.files === 0) fail(`no tiles in ${folder}`);
}

// What is falsified must be found, or the counts above mean nothing.
const [file] = filesOf(process.argv[2], ".glb");
const bytes = fs.readFileSync(file);
const text = bytes.toString("latin1");
const at = text.indexOf('"max":[') + '"max":['.length;
bytes[at] = bytes[at] === 0x37 ? 0x36 : 0x37;
if ((await checked(bytes)).numErrors === 0) fail("a falsified maximum was not found");
