"""The style that all figures share."""

from itertools import pairwise

import matplotlib as mpl
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from wetdoublet.solvers.formatting.style import EDGES, FILLS, HATCHES, INK, patch, picture, styled


def lightness(colour):
    """Return the luminance of a colour, as a print in grey has it."""
    red, green, blue = to_rgb(colour)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def test_outcomes_differ_without_colour():
    """In grey the fills are at least a tenth apart, black is legible on each, and stick-rotate-separate is hatched."""
    shades = [lightness(colour) for colour in FILLS.values()]
    assert min(later - earlier for earlier, later in pairwise(shades)) > 0.1
    assert min(shades) - lightness(INK) > 0.45
    assert [bool(hatch) for hatch in HATCHES.values()] == [False, True, False]
    legend = patch("stick-rotate-separate")
    assert (legend.get_hatch(), mpl.colors.to_hex(legend.get_edgecolor()).upper()) == (
        "///",
        EDGES["stick-rotate-separate"],
    )


def test_the_style_is_left_as_it_was():
    """Settings hold while a figure is drawn, nested as well, and are the caller's again afterwards."""
    before = dict(mpl.rcParams)

    @picture
    def drawn():
        with styled({"font.size": 5}):
            assert mpl.rcParams["font.size"] == 5
        assert mpl.rcParams["font.size"] == 9
        figure = Figure()
        figure.add_subplot().set_title("title")
        return figure

    figure = drawn()
    assert dict(mpl.rcParams) == before
    assert figure.axes[0].title.get_fontsize() == 9.5
    assert figure.axes[0].get_xticklabels()[0].get_fontsize() == 8
