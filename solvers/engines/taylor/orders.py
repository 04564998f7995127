"""Orders of the series that kernels are compiled for, declared here alone.

The cheapest order grows with the digits asked for, slowly: every order that is compiled costs a second of somebody's
time, and a neighbouring one little. With these two no decade of the tolerance costs more than 6 % above its best order
(the benchmark `orders` of release 0.3.0).
"""

ORDERS = ((3e-8, 9), (0.0, 11))
"""Tolerance, and the order of the series for it and looser ones; descending."""
LEAST, LARGEST = 8, 16
"""Orders that the runtime can be compiled for."""


def order_for(rtol: float) -> int:
    """Order of the series for a tolerance."""
    return next(order for least, order in ORDERS if rtol >= least)


def order_backward(rtol: float) -> int:
    """Order of the series for a tolerance with the adjoint sweep; with costlier steps a higher order pays earlier."""
    return order_for(rtol / 30)
