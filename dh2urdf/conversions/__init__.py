"""Between tables, chains, URDF files and Pinocchio models.

`write` a table as a URDF, `read` robot files to a tree, `chains` from trees, models and typed axes,
`assign` DH frames to a chain.
"""
