"""What a gradient to twelve parameters costs, as the table of docs/engineering/sensitivity-figures.md.

python -m tests.benchmarks.sensitivity_cost     (half a minute)
"""

from .measured.derivatives import NOTE, gradient_table, gradients

if __name__ == "__main__":
    found = [row for preset in ("granulation", "pendulum") for row in gradients(preset)]
    print(f"{NOTE}\n\n{gradient_table(found)}")  # noqa: T201 # what a script is for
