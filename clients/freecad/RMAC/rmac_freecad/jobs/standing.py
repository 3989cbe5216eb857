"""Where an object stands in its document, and how high the part is that it belongs to."""

import math


def stand_of(base):
    """A part or body that it is in can be moved without that its objects are computed anew."""
    return tuple(base.getGlobalPlacement().Matrix.A)


def top_around(base):
    """Of the solids of it, or of the body that a sketch is in; -inf where there are none."""
    group = base.getParentGeoFeatureGroup()
    tops = [_top(one) for one in (base, group) if one is not None and one.isDerivedFrom("Part::Feature")]
    return max(tops, default=-math.inf)


def _top(feature):
    if feature.Shape.isNull() or not feature.Shape.Solids:
        return -math.inf
    shape = feature.Shape.copy()
    shape.Placement = feature.getGlobalPlacement()
    return shape.BoundBox.ZMax


def below_top(label, safe_mm, top_mm):
    """What is wrong with a height to cross at; empty where nothing is."""
    return f"the height to cross at, Z {safe_mm:g}, is below the top of {label}, Z {top_mm:.4g}; cross above it" if safe_mm < top_mm else ""
