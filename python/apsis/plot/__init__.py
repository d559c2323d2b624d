"""Pictures of everything that Apsis computes, all in one style.

    python -m apsis.plot DIR             results of a run, a convergence study or a reproduction
    python -m apsis.plot md-imex-6-3     coefficients and stability regions of a method

The functions behind it return figures of matplotlib. Nothing here needs the compiled part of the package, but the names of
methods.
"""
from .methods import stability_figure, tableau_figure
from .pictures import draw
from .results import comparison_figure, distribution_figure, fields_figure, history_figure
from .run_result import read_result
from .style import PictureError

__all__ = ["PictureError", "comparison_figure", "distribution_figure", "draw", "fields_figure", "history_figure", "read_result",
           "stability_figure", "tableau_figure"]
