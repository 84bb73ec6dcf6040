"""Row 7: commands. The only place that composes everything and names drivers."""
