"""Settings that every test shares."""

from hypothesis import settings

# The first call of a kernel compiles it, so a deadline would fail on that; the same draws every time.
settings.register_profile("project", deadline=None, derandomize=True)
settings.load_profile("project")
