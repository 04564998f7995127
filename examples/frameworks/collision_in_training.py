"""A collision inside a training loop, with torch: a network learns the speed at which an impact has a wanted e_n.

python collision_in_training.py [--steps 120]    (pip install 'wetdoublet[torch]')

The loss is the collision's own: the gradient goes through the collision into the network.
"""

from __future__ import annotations

import argparse

import torch
import wetdoublet.torch


def train(steps: int) -> list[float]:
    """The mean square error of e_n at each step."""
    torch.manual_seed(1)
    law = wetdoublet.torch.law("granulation", undifferentiable="zero")  # beside a change of outcome
    network = torch.nn.Sequential(torch.nn.Linear(2, 16), torch.nn.Tanh(), torch.nn.Linear(16, 1)).double()
    optimiser = torch.optim.Adam(network.parameters(), lr=0.02)
    losses = []
    for _ in range(steps):
        share, angle = torch.empty(2, 32, dtype=torch.float64).uniform_(0.0, 1.0)
        wanted, angle = 0.9 + 0.09 * share, 0.5 * angle  # of 1; rad
        speed = 2.2 + torch.nn.functional.softplus(network(torch.stack([share, angle], 1))[:, 0])  # m/s, above a stick
        loss = ((law(speed, angle) - wanted) ** 2).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        losses.append(loss.item())
    return losses


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=120)
    losses = train(parser.parse_args().steps)
    print(f"mean square error of e_n: {losses[0]:.2e} at first, {losses[-1]:.2e} at last")
