"""Many collisions: batches and regime maps."""
