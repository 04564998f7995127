"""The speed up to which particles stick, as one number for each scene and angle, with its interval and derivatives."""
