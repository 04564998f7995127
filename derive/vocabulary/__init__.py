"""What may be spoken of: quantities, their dimensions and units, the values they may have."""
