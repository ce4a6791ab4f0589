"""What scripts/accuracy is made of: one module for each section of docs/accuracy.md, and what they share."""
