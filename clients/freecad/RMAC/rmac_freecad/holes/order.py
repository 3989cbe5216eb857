"""A short way from hole to hole."""

import numpy as np

SHORTER_MM = 1e-9
MOST_ROUNDS = 60


def short_order(places):
    """Numbers of places, x and y, from the one nearest to their lower left corner on: the nearest next, then stretches turned round as long as that is shorter."""
    at = np.asarray(places, float).reshape(-1, 2)
    if len(at) < 3:
        return list(range(len(at)))
    left = np.ones(len(at), bool)
    order = [int(np.argmin(np.hypot(*(at - at.min(0)).T)))]
    left[order[0]] = False
    for _ in range(len(at) - 1):
        far = np.where(left, np.hypot(*(at - at[order[-1]]).T), np.inf)
        order.append(int(np.argmin(far)))
        left[order[-1]] = False
    return _turned(at, np.array(order)).tolist()


def _turned(at, order):
    """The first stays; the way ends anywhere."""
    for _ in range(MOST_ROUNDS):
        changed = False
        for i in range(len(order) - 2):
            here = at[order]
            before, first = here[i], here[i + 1]
            lasts, nexts = here[i + 2 :], np.vstack([here[i + 3 :], [[np.nan, np.nan]]])
            beyond = np.nan_to_num(np.hypot(*(lasts - nexts).T) - np.hypot(*(first - nexts).T))
            gain = np.hypot(*(before - first)) - np.hypot(*(before - lasts).T) + beyond
            best = int(np.argmax(gain))
            if gain[best] > SHORTER_MM:
                order[i + 1 : i + 3 + best] = order[i + 1 : i + 3 + best][::-1].copy()
                changed = True
        if not changed:
            break
    return order
