"""Writing npz: any name of an array comes back, as NumPy reads it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from motionrt.errors import FormatError
from motionrt.untrusted.npz import read_arrays, write_arrays

ARRAYS = {
    "poses": np.arange(12.0).reshape(4, 3),
    "file": np.array([1, 2]),
    "allow_pickle": np.array(False),
    "gender": np.array("neutral"),
}


@pytest.mark.parametrize("compressed", [False, True])
def test_arrays_come_back_by_name_also_those_that_are_called_like_options_of_numpy(
    tmp_path: Path, compressed: bool
) -> None:
    file = tmp_path / "some.npz"
    with file.open("wb") as stream:
        write_arrays(stream, ARRAYS, compressed=compressed)
    with np.load(file, allow_pickle=False) as numpys:
        ours, names = read_arrays(file, lambda reason, line: FormatError(file, reason, line))
        assert sorted(names) == sorted(numpys.files) == sorted(ARRAYS)
        for name, array in ARRAYS.items():
            np.testing.assert_array_equal(numpys[name], array)
            np.testing.assert_array_equal(ours[name], array)


def test_objects_are_not_written(tmp_path: Path) -> None:
    with (tmp_path / "objects.npz").open("wb") as stream, pytest.raises(ValueError, match="Object arrays"):
        write_arrays(stream, {"a": np.array([{}])})
