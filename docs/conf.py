"""Configuration of the documentation: `python -m sphinx -W -b html docs docs/_build`."""

import os
import sys
from importlib.metadata import version as version_of
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "_ext"))
# notebooks and their shell commands find the environment that builds the site
os.environ["PATH"] = str(Path(sys.executable).parent) + os.pathsep + os.environ["PATH"]
os.environ["WETDOUBLET_DOCS"] = str(HERE)  # and the data
# as tests/helpers/flags.py, so that kernels are compiled once for both: of -O0 a fit takes more than twice as long
os.environ.setdefault("WETDOUBLET_CFLAGS", "-Og -fno-inline -fno-unroll-loops")

from gallery_pictures import WrittenPictures  # noqa: E402 -- found by the path that is set above

project = "wetdoublet"
author = "The wetdoublet developers"
release = version = version_of("wetdoublet")
language = "en"
smartquotes = False  # two dashes of an option stay two

extensions = [
    "pages",
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",
    "sphinx_click",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = [
    "_build",
    "_emitted",
    "_ext",
    "gallery/*",
    "auto_gallery/*.ipynb",
    "auto_gallery/*.py",
    "jupyter_execute",
]

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath", "amsmath"]
myst_heading_anchors = 3
nb_execution_mode = "force"  # outputs are those of the code as it is
nb_execution_in_temp = True
nb_execution_show_tb = True
nb_execution_timeout = 180
nb_execution_raise_on_error = True
nb_merge_streams = True

default_role = "literal"
autodoc_member_order = "bysource"
autodoc_typehints = "none"
python_maximum_signature_line_length = 72
napoleon_google_docstring = True
napoleon_numpy_docstring = False
copybutton_prompt_text = r">>> |\.\.\. |\$ |!"  # the last in notebooks, before commands for the shell
copybutton_prompt_is_regexp = True

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "auto_gallery",
    "filename_pattern": "",
    "image_scrapers": (WrittenPictures(),),
    "capture_repr": (),
    "remove_config_comments": True,
    "show_memory": False,
    "min_reported_time": 1e9,
    "download_all_examples": False,
    "show_signature": False,
    "copyfile_regex": r".*\.rst",
    "abort_on_example_error": True,
    "within_subsection_order": "FileNameSortKey",
}

html_theme = "furo"
html_title = "wetdoublet"
html_static_path = ["_static"]
html_extra_path = ["_emitted/site"]  # the explorer's page
html_css_files = ["site.css"]
html_show_sourcelink = False
html_show_copyright = False
html_theme_options = {"navigation_with_keys": True}
