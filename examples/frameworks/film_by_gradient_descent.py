"""Calibrates viscosity and film thickness by gradient descent, with jax: Adam on the mean square error of e_n.

python film_by_gradient_descent.py [--steps 300]    (pip install 'wetdoublet[jax]')
"""

from __future__ import annotations

import argparse

import jax
import numpy as np
import wetdoublet.jax
from jax import numpy as jnp

NAMES = ("liquid.viscosity", "liquid.film_thickness")
TRUTH = np.array([2.0, 8.0e-6])  # Pa s, m


def calibrate(steps: int) -> tuple[np.ndarray, list[float]]:
    """The entries that fit synthetic restitutions, and the loss at each step."""
    jax.config.update("jax_enable_x64", True)
    random = np.random.default_rng(1)
    speed, angle = random.uniform(2.6, 6.0, 40), random.uniform(0.0, 1.2, 40)
    law = wetdoublet.jax.law("granulation", undifferentiable="zero")  # a stick's restitution, 0, counts in the loss

    def restitution(logarithms: jax.Array) -> jax.Array:
        result: jax.Array = law(speed, angle, dict(zip(NAMES, jnp.exp(logarithms))))
        return result

    measured = restitution(jnp.log(TRUTH)) + random.normal(0.0, 1e-3, 40)
    step = jax.jit(jax.value_and_grad(lambda x: ((restitution(x) - measured) ** 2).mean()))
    x, first, second, losses = jnp.log(TRUTH * [1.3, 0.8]), jnp.zeros(2), jnp.zeros(2), []
    for k in range(1, steps + 1):
        loss, slope = step(x)
        losses.append(float(loss))
        first, second = 0.9 * first + 0.1 * slope, 0.99 * second + 0.01 * slope**2
        x -= 0.02 * (first / (1 - 0.9**k)) / (jnp.sqrt(second / (1 - 0.99**k)) + 1e-12)
    return np.exp(np.asarray(x)), losses


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=300)
    estimates, losses = calibrate(parser.parse_args().steps)
    print(f"mean square error of e_n: {losses[0]:.2e} at first, {losses[-1]:.2e} at last")
    for name, value, true in zip(NAMES, estimates, TRUTH):
        print(f"{name}: {value:.4g} (truth {true:.4g})")
