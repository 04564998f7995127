"""A scene's collision law as one C file: the kernel's text, with what a caller in C needs around it."""
