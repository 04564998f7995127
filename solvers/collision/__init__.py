"""One collision: its outcome by either engine, as text and as a figure."""
