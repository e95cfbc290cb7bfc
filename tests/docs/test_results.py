"""The figures on the page of results, and in the tables that its plots replace, are those of the records."""

import json
import re
from pathlib import Path
from statistics import median

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
FOLDER = DOCS / "benchmarks"
PAGE, DETAILS = FOLDER / "README.md", FOLDER / "details.md"


def rows(page, title):
    """Return the cells of the table of a page whose first column has a title."""
    text = page.read_text(encoding="utf-8")
    table = text[text.index(f"| {title}") :].split("\n\n", 1)[0]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()[2:]]


def figures(text):
    return [float(number.replace(",", "")) for number in re.findall(r"\d[\d,]*\.?\d*", text)]


def record(name):
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def answers():
    return dict(rows(PAGE, "question"))


@pytest.fixture(scope="module")
def ten_million():
    """What the record says of 10 million segments, by way to draw them: fiblets, aliased lines, add_mesh's."""
    results = {one["way"]: one for one in record("lines-llvmpipe")["results"] if one["segments"] == 10_038_457}
    return [results[way] for way in ("fiblets", "polylines-aliased", "polylines")]


@pytest.mark.parametrize(
    ("question", "field", "scale"),
    [
        ("How fast, software OpenGL?", "ms_per_frame", 1.0),
        ("How much memory?", "peak_memory_bytes", 1e-6),
        ("How long to load?", "load_seconds", 1.0),
    ],
)
def test_answers_for_ten_million_segments_are_those_of_the_record(answers, ten_million, question, field, scale):
    written = [number for number in figures(answers[question]) if number != 10]
    assert written == [pytest.approx(one[field] * scale, rel=0.03) for one in ten_million]


def test_bytes_on_the_gpu_are_those_of_the_record(answers, ten_million):
    bytes_per_point = [ten_million[way]["gpu_bytes_per_point"] for way in (0, 1)]
    assert figures(answers["How large?"])[1:] == [pytest.approx(one, rel=0.01) for one in bytes_per_point]


def test_frames_on_the_card_are_those_of_the_record(answers):
    results = [one for one in record("card-nvidia-h100-80gb-hbm3")["results"] if one.get("ms")]
    drawn = [one for one in results if one.get("pipeline") == "compute" and one["culling"] == "two-phase"]
    lines = [one for one in results if one["kind"] == "raw lines"]
    n, ms, more, longest, _, strips, strip_ms = figures(answers["How fast, graphics card?"].replace("H100", "100"))
    asked = (n * 1e6, ms, drawn), (more * 1e9, longest, drawn), (strips * 1e6, strip_ms, lines)
    for segments, time, members in asked:
        nearest = min(members, key=lambda one: abs(one["segments"] - segments))
        assert nearest["segments"] == pytest.approx(segments, rel=0.01)
        assert nearest["ms"] == pytest.approx(time, abs=0.06)


def test_pages_and_niivue_have_the_figures_of_the_record(answers):
    found = record("other-viewers")["niivue"]
    every = [dict(zip(found["columns"], row, strict=True)) for row in found["rows"]]
    pages = {one["points"]: one for one in every if one["program"] == "page"}
    niivue = {one["points"]: one for one in every if one["program"] == "NiiVue"}
    ten = [one[10**7][column] for one in (pages, niivue) for column in ("page_mb", "first_frame_s")]
    large, _, first, *others = figures(answers["How large is a page?"])
    assert [large, first, *others] == ten
    columns = {
        "total bytes": "page_mb",
        "seconds to the first frame": "first_frame_s",
        "seconds to the finished frame": "finished_frame_s",
        "milliseconds for a full-resolution frame": "full_frame_ms",
        "milliseconds for an interactive frame": "interactive_frame_ms",
    }
    table = {cells[0]: cells[1:] for cells in rows(DOCS / "pages.md", "page, NiiVue, PyVista")}
    for title, column in columns.items():
        for points, cell in zip(pages, table[title], strict=True):
            recorded = [one[column] for one in every if one["points"] == points and one[column] is not None]
            written = [number for part in cell.split(", ") for number in figures(part)]
            assert written == recorded, title


def test_fury_has_the_figures_of_the_record():
    table = {figures(cells[0])[0]: cells[1:] for cells in rows(DOCS / "comparison.md", "segments | FURY's lines")}
    for segments, program, times in record("other-viewers")["fury"]["rows"]:
        cell = table[segments][("FURY", "VTK lines, aliased", "fiblets").index(program)]
        assert [figures(part)[0] for part in cell.split(", ")] == times


def test_the_table_of_the_codec_is_that_of_the_record():
    names = {"fiblets": "by default", "fiblets, look-ahead": "look-ahead", "paper's fiblets": "as the paper"}
    study = record("report/amd-epyc/report")["studies"][0]
    noisy = {(one["way"], one["setting"], one["data"]): one for one in study["records"] if one["group"] == "noisy"}
    usual = {data: one for (way, setting, data), one in noisy.items() if (way, setting) == ("fiblets", "default")}
    for title, *cells in rows(DETAILS, "noisy tracking"):
        found = [
            (one, usual[data])
            for (way, setting, data), one in noisy.items()
            if names.get(way, way) in title and setting in ("default", "", None, *re.findall(r"\d+ bits", title))
        ]
        assert len(found) == 5, title
        medians = [
            median(one["costs"]["size"]["value"] for one, _ in found),
            *(median(one["errors"][f"{kind} in steps"]["value"] for one, _ in found) for kind in ("max", "mean")),
            *(median(one["times"][act]["median"] / base["times"][act]["median"] for one, base in found)
              for act in ("compress", "decompress")),
        ]  # fmt: skip
        assert figures(" ".join(cells)) == [pytest.approx(number, rel=0.05) for number in medians], title


def test_tubes_have_the_times_of_the_record():
    text = " ".join(DETAILS.read_text(encoding="utf-8").split())
    results = [one for one in record("tubes-llvmpipe")["results"] if "ms" in one]
    times = {(one["set"], one["way"], one["view"]): one["ms"] for one in results}
    for before, unit, asked in (
        ("(114,489 segments): ", 1.0, (("brain", "splines"),)),
        ("30 sides take ", 1.0, (("brain", "tube-30"),)),
        ("Bundle: ", 1.0, (("bundle", "splines"), ("bundle", "tube-30"))),
        ("Furball: ", 1000.0, (("furball", "splines"), ("furball", "tube-12"))),
    ):
        recorded = [times[*one, view] / unit for one in asked for view in ("far", "close")]
        written = figures(text.split(before)[1])[: len(recorded)]
        assert written == [pytest.approx(number, abs=0.05 if unit > 1.0 else 0.5) for number in recorded], before


def test_cpu_times_of_frames_are_those_of_the_record():
    text = " ".join(DETAILS.read_text(encoding="utf-8").split())
    results = record("frame-cost-llvmpipe")["results"]
    for chunks, part in ((12, "In 12 chunks (discrete cards) "), (93, "In 93 chunks (integrated cards) ")):
        slowest = [
            max(one["ms"] for one in results if one["case"] == case and one["chunks"] == chunks)
            for case in ("engine", "mapper")
        ]
        assert figures(text.split(part)[1])[:2] == [pytest.approx(one, abs=0.006) for one in slowest]


@pytest.mark.parametrize(
    ("title", "mode", "way", "digits"),
    [
        ("- Surfaces, ", "isosurface", "vtk-gpu", 0),
        ("- Greatest values ", "mip", "vtk-gpu-equal", 1),
        ("- Light with ", "composite", "vtk-gpu-equal", 1),
    ],
)
def test_volumes_beside_vtk_have_the_ratios_of_the_record(title, mode, way, digits):
    text = " ".join(DETAILS.read_text(encoding="utf-8").split()).split(title)[1].split(" - ")[0]
    times = {}
    for one in record("volume-llvmpipe")["results"]:
        if one["mode"] == mode and "circle" in one:
            times.setdefault(one["data"], {})[one["way"]] = one["circle"]["cpu_ms"]
    ratios = [one[way] / one["plotter"] for one in times.values() if way in one]
    written = iter(figures(text))
    assert all(f"{ratio:.{digits}f}" in (f"{number:.{digits}f}" for number in written) for ratio in ratios)
