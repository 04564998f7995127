"""Reproduction of the paper: its figures, table and numbers, and a report that compares them with ours."""
