"""Methods as reports list and name them."""

# In the order of reports; others come last.
_ORDER = ("default", "paper", "paper:flow.describe.term=exg", "paper:flow.describe.term=rgb",
          "paper:flow.describe.term=height", "paper-literal", "icp-affine", "cpd-affine", "go-icp",
          "surf", "orb", "fast-brief", "sift-affine", "fft-affine", "fpfh-gicp",
          "go-icp-oracle-scale", "fpfh-gicp-oracle-scale")
# By the rule of its paper Go-ICP has no answer before the bound is proven, which the time limit
# hardly ever leaves it; whoever uses it would take what it holds, and so do we.
_HOLDING = ("go-icp", "go-icp-oracle-scale")


def label(method):
    """A short name, for axes."""
    return method.replace(":flow.describe.term=", ", ").replace("-oracle-scale", ", true scale")


def in_order(names):
    return sorted(dict.fromkeys(names), key=lambda name: (
        _ORDER.index(name) if name in _ORDER else len(_ORDER)))


def with_held_answers(rows):
    """Rows in which Go-ICP stands by the answer that it held when its time was up."""
    accepted = rows.accepted | (rows.method.isin(_HOLDING) & (rows.status == "rejected"))
    return rows.assign(accepted=accepted, success=accepted & rows.right)
