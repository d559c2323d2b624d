"""Results of stored runs."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from .errors import FileError
from .runs import Result


def open(folder: str | Path) -> Result:  # noqa: A001, used as apsis.open
    """Returns the Result of a stored run: `run(…, out=folder)` or `apsis run --out folder`.

    Without snapshots t and fields have only the end. f has the cells of the file: every output.stride-th one, in output.precision. It
    is empty without a stored distribution, and with output.distribution_at (see points/f of the file). Raises FileError if the folder
    is not a result folder."""
    from .plot.run_result import read_result  # needs h5py and Matplotlib, which runs do not
    from .plot.style import PictureError
    try:
        stored = read_result(folder)
    except PictureError as problem:
        raise FileError(str(problem)) from problem
    manifest, empty = stored.manifest, np.zeros(0)
    result = manifest.get("result", {})
    if len(stored.t) > 0:
        t, fields = stored.t, {name: stored.snapshots[name] for name in stored.fields}
    else:
        t, fields = np.array([stored.history["t"][-1]]), {name: values[None, :] for name, values in stored.fields.items()}
    summary = {"case": manifest.get("case", {}), "method": manifest.get("method", ""), **result, "warnings": manifest.get("warnings", [])}
    arrays = stored.arrays
    return Result(state=str(manifest.get("state", "")), f=arrays.get("f", np.zeros((0, 0))), x=arrays.get("x", empty),
                  v=arrays.get("v", empty), epsilon=arrays.get("epsilon", empty), t=t, fields=fields, history=stored.history,
                  summary=summary, labels={name: stored.labels[name] for name in fields if name in stored.labels},
                  v_weights=arrays.get("v_weights", empty), axes={name: arrays[name] for name in ("v_x", "v_y", "v_z") if name in arrays},
                  marginals=stored.marginals, y=arrays.get("y", empty), z=arrays.get("z", empty), probes=stored.probes,
                  surfaces=stored.surfaces, walls=stored.walls)
