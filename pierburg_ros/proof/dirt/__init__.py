"""Recordings as they come from real benches: what disturbs the valve, and what spoils its log."""
