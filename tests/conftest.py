"""Settings shared by all tests."""

import os

from hypothesis import settings

# Two busy cores make single examples slow now and then; pytest-timeout bounds the whole test instead.
# The gate judges a change by the same examples each time; at a desk every run searches further.
settings.register_profile("tapreach", deadline=None, derandomize=bool(os.environ.get("CI")), print_blob=True)
settings.load_profile("tapreach")
