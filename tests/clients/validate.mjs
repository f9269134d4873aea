// Runs Khronos' validator on every GLB: node validate.mjs FOLDER…
//
// Those in folders named `roads` are vector content: indices that restart a strip are not valid
// glTF 2.0, but no other errors are allowed.
import fs from "node:fs";
import path from "node:path";
import validator from "gltf-validator";
import { fail, filesOf } from "./files.mjs";

/** The largest index, which belongs to no vertex. */
const RESTART = /value (65535|4294967295) that is greater/;
const checked = async (bytes) => (await validator.validateBytes(new Uint8Array(bytes))).issues;

for (const folder of process.argv.slice(2)) {
  const isVector = path.basename(folder) === "roads";
  const counts = { files: 0, errors: 0, warnings: 0, restarts: 0 };
  for (const file of filesOf(folder, ".glb")) {
    const issues = await checked(fs.readFileSync(file));
    counts.files += 1;
    const isAllowed = ({ code, message }) => isVector &&
      (code === "ACCESSOR_INDEX_PRIMITIVE_RESTART" || (code === "ACCESSOR_INDEX_OOB" && RESTART.test(message)));
    const errors = issues.messages.filter((message) => message.severity === 0 && !isAllowed(message));
    counts.errors += errors.length;
    counts.restarts += issues.messages.filter(isAllowed).length;
    counts.warnings += issues.numWarnings;
    if (errors.length) fail(`${file}: ${JSON.stringify(errors[0])}`);
  }
  console.log("glTF validator", folder, counts);
  if (isVector !== counts.restarts > 0) fail(`${folder}: ${counts.restarts} indices restart strips`);
  if (counts.files === 0) fail(`no tiles in ${folder}`);
}

// Falsified files must be detected, otherwise the counts above mean nothing.
const [file] = filesOf(process.argv[2], ".glb");
const bytes = fs.readFileSync(file);
const text = bytes.toString("latin1");
const at = text.indexOf('"max":[') + '"max":['.length;
bytes[at] = bytes[at] === 0x37 ? 0x36 : 0x37;
if ((await checked(bytes)).numErrors === 0) fail("a falsified maximum was not found");
