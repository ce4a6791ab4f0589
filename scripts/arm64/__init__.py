"""Parts of scripts/test_arm64."""
