"""Row 6: measurements; each prints a table and writes JSON."""
