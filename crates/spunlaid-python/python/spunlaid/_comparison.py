"""Results side by side."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from . import _spunlaid
from ._optional import needed
from ._results import Results

if TYPE_CHECKING:
    import pandas


class Comparison(Results):
    """What differs between runs, or between webs. `spunlaid.compare` returns it; a notebook shows its report."""

    @property
    def summary(self) -> dict[str, Any]:
        """What `comparison.json` of `spunlaid compare` holds."""
        return super().summary

    @property
    def comparisons(self) -> list[dict[str, Any]]:
        """Each of the others with the first: `run`, `against`, whether they are `paired` by replicate, the `reason`, and `measures`
        by column."""
        return list(self.summary["comparisons"])

    def to_pandas(self) -> pandas.DataFrame:
        """A row for each run and measure, in SI units: the means of both with their standard errors, the `difference` with its
        `standard_error` and half the width of its interval of 95 %, and whether it is `significant`."""
        pd = needed("pandas", "pandas", "to_pandas()")
        rows, index = [], []
        for compared in self.comparisons:
            for column, of in compared["measures"].items():
                index.append((compared["run"], column))
                sides = {name: of[name] for name in ("difference", "standard_error", "half_width", "significant")}
                means = {f"{side}_{name}": of[side][name] for side in ("against", "run") for name in ("mean", "standard_error")}
                rows.append({**means, **sides})
        return pd.DataFrame(rows, index=pd.MultiIndex.from_tuples(index, names=["run", "measure"]))

    def __repr__(self) -> str:
        against = self.comparisons[0]["against"]
        return f"<Comparison of {', '.join(of['run'] for of in self.comparisons)} with {against}>"


def compare(*folders: str | os.PathLike[str]) -> Comparison:
    """What differs between the results of runs, or of webs, and whether it is significant at 95 %: the same as `spunlaid compare`.

    folders: two or more folders of results of runs, or of webs that were laid or scanned; the first is the one to compare with
    """
    return Comparison(_spunlaid.compare_folders([os.fspath(folder) for folder in folders]))
