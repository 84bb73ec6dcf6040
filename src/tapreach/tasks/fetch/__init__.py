"""Fetching: from one tap to the thing in the claw."""
