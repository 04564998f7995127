"""`wetdoublet flow-curve`: the law of a liquid from what a rheometer measured."""

from ..errors import InputError
from . import options
from .signature import as_command


@as_command("The law of a liquid from its flow curve.")
def command(curve: str | None, output: options.Shown) -> None:
    """Fit a Newtonian, power-law, Cross, Carreau or Herschel-Bulkley liquid to the flow curve in CURVE.csv.

    Columns are a shear rate and a viscosity or stress, with units, as rheometers export them. The table `[liquid]` that
    is printed can be pasted into a scene.

    \b
    Examples:
      wetdoublet flow-curve curve.csv
      wetdoublet flow-curve curve.csv --json --plot curve.png

    Options:
        CURVE.csv (curve):
    """  # noqa: D301 -- click reads the \b, which keeps the lines of the example
    from ..fitting.flow_curve import flow_curve

    if curve is None:
        raise InputError("CURVE.csv", None, "a CSV file with a shear rate and a viscosity or stress")
    output.show(flow_curve(curve))
