"""The equations in print: LaTeX and Markdown."""
