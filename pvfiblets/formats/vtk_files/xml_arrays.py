"""The elements and arrays of VTK XML files, each size checked before memory is spent on it."""

from __future__ import annotations

import base64
import binascii
import lzma
import re
import warnings
import zlib
from os import PathLike
from typing import Any
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from pvfiblets.errors import FormatError
from pvfiblets.formats.mapped import MappedFile

Array = NDArray[Any]

_TYPES = {
    **{f"Int{b}": f"i{b // 8}" for b in (8, 16, 32, 64)},
    **{f"UInt{b}": f"u{b // 8}" for b in (8, 16, 32, 64)},
    "Float32": "f4",
    "Float64": "f8",
}
MOST_TIMES = 10_000
"""Largest ratio of contents to file size: no compressor of VTK's packs more densely, except for zeros."""

_MOST_TEXT = 1 << 16  # bytes
_COMPRESSORS = {
    "": None, "vtkZLibDataCompressor": "zlib", "vtkLZMADataCompressor": "lzma", "vtkLZ4DataCompressor": "lz4"
}  # fmt: skip
_DENSEST_LZ4 = 256  # bytes that a byte of LZ4 can become, rounded up


class Element:
    """An XML element: its tag, attributes, children, text and the byte where it begins."""

    def __init__(self, path: str, tag: str, attributes: dict[str, str], position: int) -> None:
        self._path = path
        self.tag, self.attributes, self.position = tag, attributes, position
        self.elements: list[Element] = []
        self.text: list[str] = []

    def children(self, tag: str) -> list[Element]:
        """Return the direct children of a tag, in order."""
        return [e for e in self.elements if e.tag == tag]

    def child(self, tag: str) -> Element | None:
        """Return the first direct child of a tag."""
        found = self.children(tag)
        return found[0] if found else None

    def count(self, name: str) -> int:
        """Return an attribute that is a count, 0 where it is missing."""
        text = self.attributes.get(name, "0").strip()
        if not (text.isascii() and text.isdecimal() and len(text) < 16):
            raise FormatError(self._path, self.position, f"{name}={text!r}", "a whole number")
        return int(text)


class XmlFile:
    """A VTK XML file."""

    def __init__(self, path: str | PathLike[str], kind: str | None = "PolyData") -> None:
        self.file = MappedFile(path)
        self.path = self.file.path
        head = self.file.bytes(0, min(self.file.size, 4096), "the XML header")
        if b"<VTKFile" not in head:
            raise FormatError(self.path, 0, repr(head[:20]), "an XML file with a VTKFile element")
        # What follows the tag AppendedData is not XML.
        match = re.compile(rb"<AppendedData[^>]*>\s*_").search(self.file.buffer)
        self._appended_at = match.end() if match else None
        self._appended_raw = bool(match and b'"raw"' in match[0].replace(b"'", b'"'))
        tail = self.file.bytes(max(0, self.file.size - 64), min(64, self.file.size), "the end")
        if match is not None and not tail.rstrip().endswith(b"</VTKFile>"):
            raise FormatError(self.path, self.file.size, repr(tail[-20:]), "</VTKFile>: the file is truncated")
        root = self._parse(self.file.size if match is None else match.start(), match is None)
        found = root.attributes.get("type", "")
        content = root.child(found if kind is None else kind)
        if root.tag != "VTKFile" or (kind is not None and found != kind) or content is None:
            remedy = "; extract the lines and save those" if kind == "PolyData" else ""
            raise FormatError(
                self.path, root.position, f"{root.tag} of type {found!r}", f"VTKFile of type {kind!r}{remedy}"
            )
        self.content = content  # of that kind
        order = ">" if root.attributes.get("byte_order") == "BigEndian" else "<"
        self._order = order
        wide = root.attributes.get("header_type") == "UInt64"
        self._size_type = np.dtype(f"{order}u8" if wide else f"{order}u4")
        compressor = root.attributes.get("compressor", "")
        if compressor not in _COMPRESSORS and kind == "PolyData":
            raise FormatError(
                self.path,
                root.position,
                f"compressor {compressor!r}",
                f"one of {[c for c in _COMPRESSORS if c]} or none; save the file again with zlib",
            )
        self._compressor = _COMPRESSORS.get(compressor, compressor)

    def _parse(self, stop: int, complete: bool) -> Element:
        """Parse the XML up to byte `stop` into elements."""
        root: list[Element] = []
        stack: list[Element] = []
        parser = expat.ParserCreate()

        def start(tag: str, attributes: dict[str, str]) -> None:
            element = Element(self.path, tag, attributes, parser.CurrentByteIndex)
            (stack[-1].elements if stack else root).append(element)
            stack.append(element)

        def end(_tag: str) -> None:
            stack.pop()

        def text(data: str) -> None:
            if stack and stack[-1].tag in ("DataArray", "Array"):
                stack[-1].text.append(data)

        def refuse(*_args: Any) -> None:
            at = parser.CurrentByteIndex
            raise FormatError(self.path, at, "a document type declaration", "plain VTK XML")

        parser.StartElementHandler, parser.EndElementHandler = start, end
        parser.CharacterDataHandler = text
        # Entities could blow a small file up to any size; VTK's files have none.
        parser.StartDoctypeDeclHandler = refuse
        parser.buffer_text = True
        parser.buffer_size = 1 << 16
        try:
            for first in range(0, stop, 1 << 20):
                parser.Parse(bytes(self.file.buffer[first : min(first + (1 << 20), stop)]), False)
            if complete:
                parser.Parse(b"", True)
        except expat.ExpatError as error:
            raise FormatError(self.path, parser.ErrorByteIndex, f"broken XML ({error})", "well-formed XML") from error
        if not root:
            raise FormatError(self.path, 0, "no element", "a VTKFile element")
        return root[0]

    def values(self, element: Element, rows: int, columns: int | None = None) -> Array:
        """Return the values of a DataArray in native order."""
        kind = element.attributes.get("type", "")
        if kind not in _TYPES:
            raise self.error(element, f"type {kind!r}", f"one of {list(_TYPES)}")
        k = max(1, element.count("NumberOfComponents"))
        if columns is not None and k != columns:
            raise self.error(element, f"{k} components", f"{columns}")
        dtype = np.dtype(self._order + _TYPES[kind])
        form = element.attributes.get("format", "ascii")
        if form == "ascii":
            values = self._from_text(element, dtype.newbyteorder("="))
        elif form in ("binary", "appended"):
            raw = self._binary(element, form == "appended", rows * k * dtype.itemsize)
            if len(raw) % dtype.itemsize:
                raise self.error(element, f"{len(raw)} bytes", f"a multiple of {dtype.itemsize}")
            values = np.frombuffer(raw, dtype).astype(dtype.newbyteorder("="))
        else:
            raise self.error(element, f"format {form!r}", "ascii, binary or appended")
        if len(values) != rows * k:
            raise self.error(element, f"{len(values)} values", f"{rows} rows of {k} as the piece promises")
        return values.reshape(rows, k) if k > 1 else values

    def strings(self, element: Element) -> list[str]:
        """Return the texts of a small Array of strings."""
        if element.attributes.get("format", "ascii") == "ascii":
            raw = self._from_text(element, np.dtype(np.uint8)).tobytes()
        else:
            size = self.stated(element, 0)
            if size > _MOST_TEXT:
                raise self.error(element, f"{size} bytes of text", f"at most {_MOST_TEXT}")
            raw = self._binary(element, element.attributes["format"] == "appended", size)
        return raw.decode("utf-8", "replace").split("\0")[:-1]

    def check_sizes(self, element: Element, rows: int) -> None:
        """Compare the size that a DataArray says with what the file promises elsewhere, before VTK takes memory."""
        values = rows * max(1, element.count("NumberOfComponents"))
        form, kind = element.attributes.get("format", "ascii"), element.attributes.get("type", "")
        if form == "ascii" or kind not in _TYPES:  # such as of strings
            if values > self.file.size:
                raise self.error(element, f"{values} values in {self.file.size} bytes", "fewer")
            return
        promised, source = values * np.dtype(_TYPES[kind]).itemsize, self._source(element, form == "appended")
        if promised > MOST_TIMES * self.file.size:
            raise self.error(element, f"{promised} bytes in a file of {self.file.size}", "fewer")
        if self._compressor is None:
            self._check_size(element, source.sizes(1)[0], promised)
        else:
            source.compressed_sizes(self._blocks(element, source, promised)[0])

    def stated(self, element: Element, rows: int) -> int:
        """Return the bytes that a DataArray declares, or the bytes of a number of its rows."""
        kind, form = element.attributes.get("type", ""), element.attributes.get("format", "ascii")
        size = np.dtype(_TYPES[kind]).itemsize if kind in _TYPES else 1
        promised = rows * max(1, element.count("NumberOfComponents")) * size
        if form == "ascii":
            return promised
        source = self._source(element, form == "appended")
        if self._compressor is None:
            return max(promised, *source.sizes(1))
        n, block, last = source.sizes(3)
        return max(promised, (n - 1) * block + (last or block) if n else 0)

    def error(self, element: Element, found: str, expected: str) -> FormatError:
        """Return the error of an invalid array."""
        name = element.attributes.get("Name", "")
        return FormatError(self.path, element.position, f"array {name!r} with {found}", expected)

    def _from_text(self, element: Element, dtype: np.dtype[Any]) -> Array:
        exact = np.int64 if dtype.kind == "i" else np.uint64 if dtype.kind == "u" else np.float64
        text = "".join(element.text)
        if not text.strip():
            return np.zeros(0, dtype)
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            # NumPy warns of, or raises for, text that is no number; the count judges both.
            warnings.simplefilter("ignore", DeprecationWarning)
            try:
                values = np.fromstring(text, exact, sep=" ")
            except ValueError:
                values = np.zeros(0, exact)
            if len(values) != len(text.split()):
                raise self.error(element, f"the text {text.strip()[:40]!r}", "numbers and blanks")
            return values.astype(dtype)

    def _binary(self, element: Element, appended: bool, promised: int) -> bytes:
        """Return the bytes of a binary array."""
        source = self._source(element, appended)
        if self._compressor is None:
            (size,) = source.sizes(1)
            self._check_size(element, size, promised)
            return source.data(size)
        n, block, last = self._blocks(element, source, promised)
        if n == 0:
            return b""
        packed = source.compressed_sizes(n)
        data = memoryview(source.data(int(packed.sum())))
        parts, at = [], 0
        for i, size in enumerate(packed.tolist()):
            want = last if last and i == n - 1 else block
            parts.append(self._unpack(element, data[at : at + size], want))
            at += size
        return b"".join(parts)

    def _check_size(self, element: Element, size: int, promised: int) -> None:
        if size != promised:
            raise self.error(element, f"{size} bytes", f"{promised} bytes")

    def _blocks(self, element: Element, source: _Raw | _Base64, promised: int) -> list[int]:
        """Return how many compressed blocks there are, and the bytes of one and of the last."""
        n, block, last = source.sizes(3)
        total = (n - 1) * block + (last or block) if n else 0
        if n > self.file.size or (n and total != promised):
            raise self.error(element, f"{n} blocks of {block} bytes", f"{promised} bytes")
        return [n, block, last]

    def _unpack(self, element: Element, packed: memoryview, size: int) -> bytes:
        try:
            # The bound stops what inflates to more than it says.
            if self._compressor == "zlib":
                data = zlib.decompressobj().decompress(packed, size + 1)
            elif self._compressor == "lz4":
                data = _without_lz4(bytes(packed), size)
            else:
                data = lzma.LZMADecompressor(memlimit=1 << 30).decompress(packed, size + 1)
        except (zlib.error, lzma.LZMAError, EOFError) as error:
            raise self.error(element, f"damaged blocks ({error})", "compressed blocks") from error
        if len(data) != size:
            raise self.error(element, f"a block of {len(data)} bytes", f"{size} bytes")
        return data

    def _source(self, element: Element, appended: bool) -> _Raw | _Base64:
        return self._appended(element) if appended else self._inline(element)

    def _inline(self, element: Element) -> _Raw | _Base64:
        text = "".join("".join(element.text).split()).encode("ascii", "replace")
        return _Base64(self, element, text, 0, self._size_type)

    def _appended(self, element: Element) -> _Raw | _Base64:
        if self._appended_at is None:
            raise self.error(element, "format 'appended'", "an AppendedData element")
        at = self._appended_at + element.count("offset")
        if self._appended_raw:
            return _Raw(self, element, at, self._size_type)
        if at > self.file.size:
            self.file.check(at, 1, f"array {element.attributes.get('Name', '')!r}")
        return _Base64(self, element, self.file.buffer, at, self._size_type)


class _Source:
    """Binary data that begins with numbers of the header's type."""

    def __init__(self, home: XmlFile, element: Element, size_type: np.dtype[Any]) -> None:
        self._home, self._element, self._size_type = home, element, size_type


class _Raw(_Source):
    def __init__(self, home: XmlFile, element: Element, at: int, size_type: np.dtype[Any]) -> None:
        super().__init__(home, element, size_type)
        self._at = at

    def _take(self, n: int) -> Array:
        name = self._element.attributes.get("Name", "")
        values = self._home.file.array(self._size_type, self._at, n, f"array {name!r}")
        self._at += values.nbytes
        return values

    def sizes(self, n: int) -> list[int]:
        """Return the first `n` numbers."""
        return [int(v) for v in self._take(n)]

    def compressed_sizes(self, n: int) -> Array:
        """Return the `n` sizes of blocks that follow the three first numbers."""
        return _bounded(self._home, self._element, self._take(n))

    def data(self, size: int) -> bytes:
        """Return the bytes after the numbers read last."""
        name = self._element.attributes.get("Name", "")
        return self._home.file.bytes(self._at, size, f"array {name!r}")


class _Base64(_Source):
    """Base64 text: one stretch for numbers and data, or, if compressed, one for each."""

    def __init__(self, home: XmlFile, element: Element, text: Any, at: int, size_type: np.dtype[Any]) -> None:
        super().__init__(home, element, size_type)
        self._text, self._at = text, at
        self._header = 0

    def _decode(self, at: int, n_bytes: int) -> bytes:
        """Decode a stretch of text that holds `n_bytes` bytes."""
        length = -(-n_bytes // 3) * 4
        text = self._text[at : at + length]
        try:
            data = base64.b64decode(text, validate=True)
        except (binascii.Error, ValueError) as error:
            raise self._home.error(
                self._element, f"damaged base64 ({error})", f"{length} characters of base64"
            ) from error
        if len(data) < n_bytes:
            raise self._home.error(self._element, f"{len(data)} bytes of base64", f"{n_bytes} bytes")
        return data

    def sizes(self, n: int) -> list[int]:
        self._header = n * self._size_type.itemsize
        raw = self._decode(self._at, self._header)[: self._header]
        return [int(v) for v in np.frombuffer(raw, self._size_type)]

    def compressed_sizes(self, n: int) -> Array:
        self._header += n * self._size_type.itemsize
        raw = self._decode(self._at, self._header)[: self._header]
        sizes = np.frombuffer(raw, self._size_type)[3:]
        self._at += -(-self._header // 3) * 4
        self._header = 0
        return _bounded(self._home, self._element, sizes)

    def data(self, size: int) -> bytes:
        return self._decode(self._at, self._header + size)[self._header : self._header + size]


def _without_lz4(packed: bytes, size: int) -> bytes:
    """Return the bytes of a block, none if it is damaged or holds another number of them than `size`."""
    from vtkmodules.vtkIOCore import vtkLZ4DataCompressor

    if size > _DENSEST_LZ4 * len(packed):
        return b""
    data = np.empty(size, np.uint8)
    compressor: Any = vtkLZ4DataCompressor()
    compressor.AddObserver("ErrorEvent", lambda *_: None)  # else VTK prints
    return data[: compressor.Uncompress(packed, len(packed), data, size)].tobytes()


def _bounded(home: XmlFile, element: Element, sizes: Array) -> Array:
    """Return block sizes as int64, none larger than the file."""
    if len(sizes) and int(sizes.max()) > home.file.size:
        raise home.error(element, f"a block of {int(sizes.max())} bytes", "less than the file")
    return sizes.astype(np.int64)
