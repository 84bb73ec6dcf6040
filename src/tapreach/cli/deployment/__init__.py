"""What `tapreach install` writes: a service, its pairing token, and a hotspot."""
