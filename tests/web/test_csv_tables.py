"""Tables and profiles as CSV, read back by the standard library and compared with NumPy."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest

from pvfiblets.web import csv_tables
from pvfiblets.web.csv_tables import profile_csv, selection_csv
from pvfiblets.web.selection_tab import SelectionActions
from tests.web.desk import Desk


def rows(text):
    return list(csv.DictReader(io.StringIO(text, newline="")))


def test_the_table_has_every_selected_streamline_in_full(scene, folder, lines, monkeypatch):
    monkeypatch.setattr(csv_tables, "PIECE", 4)
    layer = scene.open("lines.fiblets")
    scene.rename(layer.id, 'tracts, "all"')
    scene.set(layer.id, "scalars", "fa")
    with pytest.raises(ValueError, match="nothing is selected"):
        selection_csv(scene)
    chosen = [1, 2, 3, 29, 30, 40, 59]
    scene.select(layer.id, chosen)
    found = rows(selection_csv(scene))
    assert [int(row["streamline"]) for row in found] == chosen
    assert {row["layer"] for row in found} == {'tracts, "all"'}
    assert [row["groups"] for row in found] == 4 * ["near"] + 3 * ["far"]
    np.testing.assert_allclose([float(row["length_mm"]) for row in found], lines.lengths()[chosen], rtol=1e-4)
    assert {row["value_of"] for row in found} == {"mean of fa"}
    np.testing.assert_allclose([float(row["value"]) for row in found], 0.5, atol=0.01)
    monkeypatch.setattr(csv_tables, "MOST_ROWS", 6)
    with pytest.raises(ValueError, match="7 streamlines are selected, and a table takes 6"):
        selection_csv(scene)


def test_the_profile_is_the_one_that_is_shown(scene, folder):
    layer = scene.open("lines.fiblets")
    desk = Desk(scene, folder)
    desk.selecting = SelectionActions(desk)
    scene.select(layer.id, [3, 4])
    desk.selecting.set_profile("fa")
    found = rows(desk.selecting.profile_csv())
    assert list(found[0]) == ["share_of_length", "mean of fa", "standard deviation of fa"]
    along = [float(row["share_of_length"]) for row in found]
    np.testing.assert_allclose(along, np.linspace(0, 1, 100))
    np.testing.assert_allclose([float(row["mean of fa"]) for row in found], along, atol=0.01)
    desk.selecting.set_profile("curvature")
    assert "mean of curvature [1/mm]" in rows(desk.selecting.profile_csv())[0]


@pytest.mark.parametrize("name", ["=cmd|' /C calc'!A0", "+1+1", "-2", "@SUM(A1)", "\t=1"])
def test_names_are_no_formulas(scene, name):
    layer = scene.open("lines.fiblets")
    scene.become(type(scene.state)((__import__("dataclasses").replace(scene.layer(layer.id), name=name),)))
    scene.select(layer.id, [3])
    (row,) = rows(selection_csv(scene))
    assert row["layer"] == f"'{name}"
    text = profile_csv({"position": [0.0], "mean": [-1.5], "std": [None]}, name)
    head, values = list(csv.reader(io.StringIO(text, newline="")))
    assert not any(cell.startswith(("=", "+", "-", "@", "\t")) for cell in head)
    assert values == ["0.0", "-1.5", ""]  # numbers are numbers
