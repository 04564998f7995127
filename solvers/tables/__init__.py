"""Tables of a collision law: Chebyshev series between traced boundaries, with an error that is tested."""
