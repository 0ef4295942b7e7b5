"""The paper's figures: tables of runs (sweep), the runs it needs (plan), what is measured of them
(measures), pictures (figures), its claims with our verdict (claims) and the page (page)."""
