"""What `tapreach doctor` looks at."""
