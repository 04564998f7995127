"""The vocabulary: quantities, their dimensions and units, and the values they may take."""
