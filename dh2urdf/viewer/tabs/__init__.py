"""Tabs of the view, and what they show."""
