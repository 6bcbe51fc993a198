"""How a scene of Gaussians begins, and how their number changes while it is fitted."""
