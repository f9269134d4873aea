// loaders.gl decodes the compressed tiles to the same bits as the uncompressed ones: node
// decode.mjs PLAIN COMPRESSED
import fs from "node:fs";
import path from "node:path";
import { parse } from "@loaders.gl/core";
import { GLTFLoader, postProcessGLTF } from "@loaders.gl/gltf";
import { fail, filesOf } from "./files.mjs";

const [plain, compressed] = process.argv.slice(2);

async function primitivesOf(file) {
  const bytes = fs.readFileSync(file);
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  const gltf = await parse(buffer, GLTFLoader, { core: { worker: false }, gltf: { loadImages: false } });
  return postProcessGLTF(gltf).meshes[0].primitives;
}

const same = (one, other) => one.length === other.length && one.every((number, k) => Object.is(number, other[k]));

/** Triangles may begin with another of their corners after decoding. */
function canonical(indices, mode) {
  if (mode !== 4) return Array.from(indices);
  const all = [];
  for (let k = 0; k < indices.length; k += 3) {
    const three = [indices[k], indices[k + 1], indices[k + 2]];
    const first = three.indexOf(Math.min(...three));
    all.push(three[first], three[(first + 1) % 3], three[(first + 2) % 3]);
  }
  return all;
}

const counts = { tiles: 0, primitives: 0, vertices: 0 };
for (const file of filesOf(plain, ".glb")) {
  const other = path.join(compressed, path.relative(plain, file));
  const [expected, found] = [await primitivesOf(file), await primitivesOf(other)];
  if (expected.length !== found.length) fail(`${other} has other parts`);
  for (const [k, primitive] of expected.entries()) {
    for (const [name, accessor] of Object.entries(primitive.attributes)) {
      if (!same(accessor.value, found[k].attributes[name].value)) fail(`${other}: ${name} differs`);
    }
    const [one, two] = [primitive, found[k]].map((own) => canonical(own.indices.value, own.mode ?? 4));
    if (!same(one, two)) fail(`${other}: indices differ`);
    counts.primitives += 1;
    counts.vertices += primitive.attributes.POSITION.count;
  }
  counts.tiles += 1;
}
console.log("loaders.gl", compressed, counts);
if (counts.vertices === 0) fail("nothing was compared");
