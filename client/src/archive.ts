/**
 * The container of .fiblets files: a stored zip of .npy arrays (docs/reference/fiblets-files.md), read as views.
 */

export class FileError extends Error {}

export type Numbers =
  | Uint8Array | Int8Array | Uint16Array | Int16Array | Uint32Array | Int32Array | Float32Array | Float64Array
  | BigInt64Array | BigUint64Array;

export interface NpyArray {
  shape: number[];
  data: Numbers;
}

export interface Archive {
  header: any;
  arrays: Map<string, NpyArray>;
  ready: number;        // fiblets whose data have come
}

const END = 0x06054b50, END64 = 0x06064b50, LOCATOR64 = 0x07064b50, CENTRAL = 0x02014b50, LOCAL = 0x04034b50;
const HEADER = "header.json", AGAIN = "Copy or make the file again.";
/** Bytes that hold the headers of a member. */
const HEADS = 4096;

function big(view: DataView, at: number): number {
  return view.getUint32(at, true) + view.getUint32(at + 4, true) * 4294967296;
}

/** Start of the central directory, and its number of members. */
function directory(view: DataView): [number, number] {
  const size = view.byteLength;
  for (let at = size - 22; at >= Math.max(0, size - 65558); --at) {
    if (view.getUint32(at, true) !== END) continue;
    if (at >= 20 && view.getUint32(at - 20, true) === LOCATOR64) {
      const far = big(view, at - 12);
      if (far + 56 <= size && view.getUint32(far, true) === END64) return [big(view, far + 48), big(view, far + 32)];
    }
    return [view.getUint32(at + 16, true), view.getUint16(at + 10, true)];
  }
  throw new FileError("This is no whole .fiblets file: the end of its zip archive is missing. Copy or make it again.");
}

/** Lengths and offset of a member, from its 64-bit extra field where the short ones are full. */
function long(view: DataView, at: number, name: number, extra: number): [number, number] {
  let size = view.getUint32(at + 24, true), offset = view.getUint32(at + 42, true);
  let packed = view.getUint32(at + 20, true);
  for (let p = at + 46 + name, end = p + extra; p + 4 <= end; ) {
    const id = view.getUint16(p, true), length = view.getUint16(p + 2, true);
    let q = p + 4;
    if (id === 1) {
      if (size === 0xffffffff) { size = big(view, q); q += 8; }
      if (packed === 0xffffffff) { packed = big(view, q); q += 8; }
      if (offset === 0xffffffff) offset = big(view, q);
    }
    p += 4 + length;
  }
  return [size, offset];
}

const KINDS: Record<string, [number, new (buffer: ArrayBuffer, at: number, n: number) => Numbers]> = {
  "|u1": [1, Uint8Array], "|i1": [1, Int8Array], "|b1": [1, Uint8Array], "<u2": [2, Uint16Array], "<i2": [2, Int16Array],
  "<u4": [4, Uint32Array], "<i4": [4, Int32Array], "<f4": [4, Float32Array], "<f8": [8, Float64Array],
  "<i8": [8, BigInt64Array], "<u8": [8, BigUint64Array],
};

/** A buffer as an array of a type; null of a type that is not of numbers. */
export function numbersOf(type: string, buffer: ArrayBuffer): Numbers | null {
  const kind = KINDS[type];
  return kind ? new kind[1](buffer, 0, buffer.byteLength / kind[0]) : null;
}

/** Read one .npy array of a piece of a file; of a type that is not of numbers, nothing. */
function readNpy(bytes: Uint8Array, name: string): NpyArray | null {
  const damaged = new FileError(`The member ${name} of the file is damaged. ${AGAIN}`);
  if (bytes.length < 10 || bytes[0] !== 0x93 || bytes[6] !== 1) throw damaged;
  const length = bytes[8] | (bytes[9] << 8);
  const text = new TextDecoder("latin1").decode(bytes.subarray(10, 10 + length));
  const descr = /'descr':\s*'([^']+)'/.exec(text), shape = /'shape':\s*\(([^)]*)\)/.exec(text);
  if (!descr || !shape || /'fortran_order':\s*True/.test(text)) throw damaged;
  const kind = KINDS[descr[1]];
  if (!kind) return null;
  const sizes = shape[1].split(",").map((part) => part.trim()).filter((part) => part).map(Number);
  const n = sizes.reduce((a, b) => a * b, 1), start = bytes.byteOffset + 10 + length;
  if (!sizes.every((size) => Number.isSafeInteger(size) && size >= 0) || 10 + length + n * kind[0] > bytes.length) throw damaged;
  const buffer = bytes.buffer as ArrayBuffer;
  const data = start % kind[0] === 0 ? new kind[1](buffer, start, n) : new kind[1](buffer.slice(start, start + n * kind[0]), 0, n);
  return { shape: sizes, data };
}

/** Open an archive that is in memory. */
export function readArchive(bytes: Uint8Array): Archive {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 22) throw new FileError("This is no .fiblets file: it is empty, or cut short.");
  const [start, count] = directory(view);
  const arrays = new Map<string, NpyArray>();
  let header: any = null, at = start;
  for (let i = 0; i < count; ++i) {
    if (at + 46 > bytes.length || view.getUint32(at, true) !== CENTRAL)
      throw new FileError(`The list of the file's members is damaged. ${AGAIN}`);
    const nameSize = view.getUint16(at + 28, true), extra = view.getUint16(at + 30, true), comment = view.getUint16(at + 32, true);
    const name = new TextDecoder().decode(bytes.subarray(at + 46, at + 46 + nameSize));
    const [size, offset] = long(view, at, nameSize, extra);
    if (view.getUint16(at + 10, true) !== 0)
      throw new FileError(
        `The member ${name} of the file is compressed; .fiblets files store their members as they are.`,
      );
    if (offset + 30 > bytes.length || view.getUint32(offset, true) !== LOCAL)
      throw new FileError(`The member ${name} of the file is damaged. ${AGAIN}`);
    const data = offset + 30 + view.getUint16(offset + 26, true) + view.getUint16(offset + 28, true);
    if (data + size > bytes.length) throw new FileError(`The file ends within its member ${name}. Copy or make it again.`);
    const member = bytes.subarray(data, data + size);
    if (name === HEADER) {
      header = readHeader(member);
    } else {
      const array = readNpy(member, name);
      if (array) arrays.set(name, array);
    }
    at += 46 + nameSize + extra + comment;
  }
  return whole(header, arrays, Infinity);
}

function readHeader(bytes: Uint8Array): unknown {
  try {
    return JSON.parse(new TextDecoder().decode(bytes));
  } catch {
    throw new FileError(`The file's header is damaged. ${AGAIN}`);
  }
}

function whole(header: any, arrays: Map<string, NpyArray>, ready: number): Archive {
  if (header === null || typeof header !== "object")
    throw new FileError("This is a zip archive, but no .fiblets file: it has no header.json.");
  return { header, arrays, ready };
}

/** A file whose parts arrive on demand; views of `bytes` see them arrive. */
export interface Parts {
  bytes: Uint8Array;
  need(begin: number, end: number): Promise<void>;
}

/** Open an archive by the headers before its members, and read only the table of pages; stop behind the codes and the requested values. */
export async function openParts(parts: Parts, values: string[]): Promise<Archive> {
  const { bytes } = parts, view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), arrays = new Map<string, NpyArray>();
  let header: any = null;
  for (let at = 0; at + 30 <= bytes.length; ) {
    await parts.need(at, Math.min(at + HEADS, bytes.length));
    if (view.getUint32(at, true) !== LOCAL) break;
    const nameSize = view.getUint16(at + 26, true), extra = view.getUint16(at + 28, true), data = at + 30 + nameSize + extra;
    const name = new TextDecoder().decode(bytes.subarray(at + 30, at + 30 + nameSize));
    let size = view.getUint32(at + 18, true);
    for (let p = at + 30 + nameSize; size === 0xffffffff && p + 20 <= data; p += 4 + view.getUint16(p + 2, true)) {
      if (view.getUint16(p, true) === 1) size = big(view, p + 4);
    }
    if (view.getUint16(at + 8, true) !== 0 || data + size > bytes.length)
      throw new FileError(`The member ${name} of the file is damaged. ${AGAIN}`);
    if (name === HEADER) {
      await parts.need(data, data + size);
      header = readHeader(bytes.subarray(data, data + size));
    } else {
      const array = readNpy(bytes.subarray(data, data + size), name);
      if (array) arrays.set(name, array);
      if (array && (array.data.buffer !== bytes.buffer || name === "pages.npy" || name.startsWith("table/"))) {
        await parts.need(data, data + size);
        arrays.set(name, readNpy(bytes.subarray(data, data + size), name)!);
      }
    }
    if (arrays.has("codes.npy") && values.every((value) => arrays.has(header?.per_point?.[value]?.member))) break;
    at = data + size;
  }
  return whole(header, arrays, 0);
}

const ELEMENTS: [string, number, number][] = [
  // of a member: how many a fiblet, streamline's part or point has, and which column of pages counts those
  ["anchors.npy", 2, -1],
  ["decoding.npy", 3, -1],
  ["anchors_low.npy", 3, -1],
  ["rank_to_id.npy", 1, 0],
  ["codes.npy", 1, 1],
];

/** Have all that draws the fiblets of some pages, and the values of their points that are named. */
export async function needPages(
  parts: Parts,
  archive: Archive,
  first: number,
  last: number,
  perPage: number,
  values: string[],
): Promise<void> {
  const table = archive.arrays.get("pages.npy")!.data as BigInt64Array,
    n = archive.header.n_fiblets;
  const members = [
    ...ELEMENTS,
    ...values.map((name): [string, number, number] => [archive.header.per_point?.[name]?.member, 1, 2]),
  ];
  await Promise.all(
    members.map(([name, columns, counted]) => {
      const array = archive.arrays.get(name)?.data;
      if (!array) return undefined;
      const [begin, end] = [first, last].map(
        (page) =>
          (counted < 0 ? Math.min(page * perPage, n) * columns : Number(table[3 * page + counted])) *
          array.BYTES_PER_ELEMENT,
      );
      return parts.need(
        array.byteOffset + begin,
        Math.min(array.byteOffset + end + (counted === 1 ? 4 : 0), parts.bytes.length),
      );
    }),
  );
}
