"""Nodes without an id, by CiA 305, without a bus."""

import unittest

import lss_nodes


def fast_scan(node, asked, bit, part, following):
    """Whether the node answers."""
    before = len(node.frames)
    node.handle(0x7E5, bytes([0x51]) + asked.to_bytes(4, "little") + bytes([bit, part, following]), 0.0)
    return len(node.frames) > before


def make(serial, when_selected):
    frames = []
    node = lss_nodes.make(lambda identifier, data: frames.append((identifier, bytes(data))), serial, when_selected)
    node.frames = frames
    return node


def find(node):
    fast_scan(node, 0, 0x80, 0, 0)
    for part, value in enumerate(node.objects.identity):
        assert fast_scan(node, value, 0, part, (part + 1) % 4)


class FastScan(unittest.TestCase):
    def test_selects_the_node_that_it_finds(self):
        for manner in lss_nodes.MANNERS:
            node = make(7, manner)
            self.assertTrue(fast_scan(node, 0, 0x80, 0, 0))
            self.assertFalse(fast_scan(node, 1, 0, 0, 1), "another vendor")
            find(node)
            node.handle(0x7E5, bytes([0x11, 9, 0, 0, 0, 0, 0, 0]), 0.0)
            self.assertEqual(node.frames[-1], (0x7E4, bytes([0x11]) + bytes(7)), "it takes a node id")
            node.handle(0x7E5, bytes([4, 0, 0, 0, 0, 0, 0, 0]), 0.0)
            self.assertFalse(fast_scan(node, 0, 0x80, 0, 0), "it has one")

    def test_a_selected_node_answers_as_its_manner_is(self):
        for manner, same, other in (("", False, False), ("matches", True, False), ("answers", True, True)):
            node = make(7, manner)
            find(node)
            self.assertEqual(fast_scan(node, 0, 0x80, 0, 0), same)
            self.assertEqual(fast_scan(node, 0x2A5, 0, 0, 0), same)
            self.assertEqual(fast_scan(node, 0x2A4, 0, 0, 0), other, "another vendor")
            node.handle(0x7E5, bytes([4, 0, 0, 0, 0, 0, 0, 0]), 0.0)
            self.assertTrue(fast_scan(node, 0, 0x80, 0, 0), "it waits again")


if __name__ == "__main__":
    unittest.main()
