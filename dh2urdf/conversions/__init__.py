"""Between tables, chains, URDF files and Pinocchio models; one file a direction."""
