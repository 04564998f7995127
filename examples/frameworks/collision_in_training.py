"""A collision inside a training loop, with torch: a network learns the speed at which an impact has a wanted e_n.

python collision_in_training.py [--steps 300]    (pip install 'wetdoublet[torch]')

The loss is the collision's own: the gradient goes through the collision into the network.
"""

from __future__ import annotations

import argparse

import torch
import wetdoublet.torch


def train(steps: int) -> list[float]:
    """The mean square error of e_n at each step."""
    torch.manual_seed(1)
    law = wetdoublet.torch.law(
        "granulation", undifferentiable="zero"
    )  # at a change of outcome: the next step is off it
    network = torch.nn.Sequential(torch.nn.Linear(2, 16), torch.nn.Tanh(), torch.nn.Linear(16, 1)).double()
    optimiser = torch.optim.Adam(network.parameters(), lr=0.01)
    losses = []
    for _ in range(steps):
        wanted, angle = torch.empty(2, 64, dtype=torch.float64).uniform_(0.0, 1.0)
        wanted = 0.7 + 0.25 * wanted
        speed = 2.2 + torch.nn.functional.softplus(network(torch.stack([wanted, angle], 1))[:, 0])  # m/s, above a stick
        loss = ((law(speed, angle) - wanted) ** 2).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        losses.append(loss.item())
    return losses


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=300)
    losses = train(parser.parse_args().steps)
    print(f"mean square error of e_n: {losses[0]:.2e} at first, {losses[-1]:.2e} at last")
