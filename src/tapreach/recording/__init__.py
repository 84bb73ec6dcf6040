"""Row 3: what happened, on disk."""
