"""The page of what other programs do has a row for each test that runs them."""

from importlib import import_module

from tests.programs.rows import PAGE, ROWS, cells


def test_the_page_of_programs_has_each_test():
    for name in ("mrtrix", "paraview", "python_packages"):
        import_module(f"tests.programs.test_{name}")
    shown = PAGE.read_text().splitlines()
    for program, test in ROWS:
        what, _, *rest = cells(program, test)
        start, end = f"| {what} | {program}", f"{' | '.join(rest)} |"
        assert any(line.startswith(start) and line.endswith(end) for line in shown), what
    assert sum(line.endswith("` |") for line in shown) == len({test for _, test in ROWS})
