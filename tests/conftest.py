"""Settings shared by all tests."""

from hypothesis import settings

# Two busy cores make single examples slow now and then; pytest-timeout bounds the whole test instead.
settings.register_profile("tapreach", deadline=None)
settings.load_profile("tapreach")
