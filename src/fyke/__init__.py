"""fyke simulates fishing and aquaculture netting in water."""
