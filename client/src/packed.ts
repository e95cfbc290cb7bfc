/**
 * Arrays of small .fiblets files (docs/reference/fiblets-files.md): Huffman codes of bytes, given the byte before.
 */

import { Archive, FileError, Numbers, numbersOf } from "./archive";

interface Packed {
  dtype: string;
  shape: number[];
  streams: [number, number, number][];  // whether of differences, shift, bytes of the lengths of codes
}

const BLOCK = 1 << 17, LONGEST = 11, SLOTS = 1 << LONGEST, ALONE = 15, NONE = 0xff00;

/** The byte that each `LONGEST` bits begin with, and its length above, by context. */
function tableOf(lengths: Uint8Array, contexts: number): Uint16Array {
  const table = new Uint16Array(contexts * SLOTS).fill(NONE);
  const put = (context: number, byte: number, code: number, length: number): void => {
    for (let slot = code; slot < SLOTS; slot += 1 << length) table[context * SLOTS + slot] = (length << 8) | byte;
  };
  for (let context = 0; context < contexts; ++context) {
    const of = (byte: number): number => (lengths[128 * context + (byte >> 1)] >> (4 * (byte & 1))) & 15;
    let code = 0;
    for (let length = 1; length <= LONGEST; ++length, code <<= 1) {
      for (let byte = 0; byte < 256; ++byte) {
        if (of(byte) !== length) continue;
        let reverse = 0;
        for (let bit = 0; bit < length; ++bit) reverse |= ((code >> bit) & 1) << (length - 1 - bit);
        put(context, byte, reverse, length);
        ++code;
      }
    }
    for (let byte = 0; byte < 256; ++byte) if (of(byte) === ALONE) put(context, byte, 0, 0);
  }
  return table;
}

/** Decode a block into `out`; false if it is damaged. */
function decode(packed: Uint8Array, table: Uint16Array, shift: number, out: Uint8Array): boolean {
  let bits = 0, held = 0, at = 0, before = 0;
  for (let i = 0; i < out.length; ++i) {
    while (held < LONGEST && at < packed.length) {
      bits |= packed[at++] << held;
      held += 8;
    }
    const entry = table[(before >> shift) * SLOTS + (bits & (SLOTS - 1))], length = entry >> 8;
    if (length > held) return false;
    bits >>>= length;
    held -= length;
    before = out[i] = entry & 255;
  }
  return at === packed.length && bits === 0;
}

async function inflated(bytes: Uint8Array): Promise<Uint8Array> {
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Unpack an array; null if it is damaged. */
async function unpackOne(facts: Packed, packed: Uint8Array): Promise<Numbers | null> {
  const itemSize = Number(facts.dtype.slice(2)), size = itemSize * facts.shape.reduce((a, b) => a * b, 1);
  const rows = itemSize === 1 ? size : facts.shape[0], columns = size / rows / 2;
  const made = new Uint8Array(size), words = new Uint16Array(made.buffer, 0, size >> 1);
  let at = 0;
  for (let i = 0; i < facts.streams.length; ++i) {
    const [, shift, model] = facts.streams[i], blocks = Math.ceil(rows / BLOCK);
    const lengths = await inflated(packed.subarray(at, at + model));
    if (lengths.length !== 128 * (256 >> shift)) return null;
    const table = tableOf(lengths, 256 >> shift), stream = itemSize === 1 ? made : new Uint8Array(rows);
    const heads = new DataView(packed.buffer, packed.byteOffset + at + model, 8 * blocks);
    at += model + 8 * blocks;
    for (let block = 0; block < blocks; ++block) {
      const end = at + heads.getUint32(8 * block, true);
      const out = stream.subarray(block * BLOCK, Math.min((block + 1) * BLOCK, rows));
      if (end > packed.length || !decode(packed.subarray(at, end), table, shift, out)) return null;
      at = end;
    }
    if (itemSize > 1) for (let row = 0, word = i >> 1; row < rows; ++row, word += columns) words[word] |= stream[row] << (8 * (i & 1));
  }
  for (let column = 0; itemSize > 1 && column < columns; ++column) {
    if (!facts.streams[2 * column][0]) continue;
    for (let row = 1, word = columns + column; row < rows; ++row, word += columns) words[word] += words[word - columns];
  }
  return numbersOf(facts.dtype, made.buffer) ?? made;
}

/** Unpack the arrays of an archive that are packed. */
export async function unpacked(archive: Archive): Promise<Archive> {
  for (const [name, facts] of Object.entries((archive.header.packed ?? {}) as Record<string, Packed>)) {
    // Where facts and bytes disagree, the browser has errors of its own, such as "Failed to fetch".
    const data = await unpackOne(facts, archive.arrays.get(name)?.data as Uint8Array).catch(() => null);
    if (!data) throw new FileError(`The member ${name} of the file is damaged. Copy or make the file again.`);
    archive.arrays.set(name, { shape: facts.shape, data });
  }
  return archive;
}
