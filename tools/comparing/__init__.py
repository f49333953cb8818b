"""How far finished runs of minamo are from one of them: histories, places of the liquid, order of convergence."""
