"""Pictures of runs, studies and methods in one style.

    python -m apsis.plot DIR             results of a run, a convergence study or a reproduction
    python -m apsis.plot md-imex-6-3     coefficients and stability regions of a method

The functions below return Matplotlib figures. Only method names need the compiled module of the package.
"""
from .comparison import comparison_figure
from .methods import stability_figure, tableau_figure
from .pictures import draw
from .results import distribution_figure, fields_figure, history_figure
from .run_result import read_result
from .style import PictureError

__all__ = ["PictureError", "comparison_figure", "distribution_figure", "draw", "fields_figure", "history_figure", "read_result",
           "stability_figure", "tableau_figure"]
