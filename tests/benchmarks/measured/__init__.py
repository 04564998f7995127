"""What is measured and not asserted: run time against achieved error, what a feature costs, cold start."""
