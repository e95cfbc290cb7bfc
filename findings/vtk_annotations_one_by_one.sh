#!/usr/bin/env bash
# VTK 9.7.2: naming the k categories of a look-up table takes time that grows faster than k squared.
#
# vtkScalarsToColors::SetAnnotation, the usual call (PyVista's `LookupTable.annotations = {...}` makes it once for each),
# builds the whole map from values to indices anew each time. The same names, set by one call of SetAnnotations, take
# milliseconds. A label table of an atlas with 5,000 names waits for minutes, before anything is drawn and without a word.
#
# Seen here: 250 names one by one 0.01 s, 1,000 names 0.6 s, 5,041 names 104 s; 1,000 together 0.002 s.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check vtk==9.7.2 numpy==2.3.5
cd "$work"
"$work/venv/bin/python" - <<'CODE'
import time

from vtkmodules.vtkCommonCore import vtkLookupTable, vtkStringArray, vtkVariant, vtkVariantArray, vtkVersion


def seconds(act):
    begun = time.process_time()
    act()
    return time.process_time() - begun


def one_by_one(table, count):
    for i in range(count):
        table.SetAnnotation(vtkVariant(float(i)), f"label {i}")


def together(table, count):
    values, names = vtkVariantArray(), vtkStringArray()
    for i in range(count):
        values.InsertNextValue(vtkVariant(float(i)))
        names.InsertNextValue(f"label {i}")
    table.SetAnnotations(values, names)


tables = [vtkLookupTable() for _ in range(3)]
few = seconds(lambda: one_by_one(tables[0], 250))
many = seconds(lambda: one_by_one(tables[1], 1000))
bulk = seconds(lambda: together(tables[2], 1000))
print(f"VTK {vtkVersion().GetVTKVersion()}: 250 one by one {few:.2f} s, 1,000 {many:.2f} s, 1,000 together {bulk:.4f} s")
assert all(tables[1].GetAnnotation(i) == tables[2].GetAnnotation(i) for i in range(1000))
assert many > 8 * few, "setting names one by one no longer takes more time than their number squared does"
assert many > 50 * bulk, "setting names one by one no longer costs more than setting them together"
CODE
