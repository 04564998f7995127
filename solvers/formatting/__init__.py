"""Numbers, units and tables as text and as labelled data; reports; the style of figures."""
