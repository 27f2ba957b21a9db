"""Pictures of what an arm reaches: the planar arm's surface, sections through a spatial arm."""
