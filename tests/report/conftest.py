"""What studies find must not depend on the machine."""

import pytest


@pytest.fixture(autouse=True, scope="module")
def _no_data_of_this_machine():
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("PVFIBLETS_DATA", raising=False)
        yield
