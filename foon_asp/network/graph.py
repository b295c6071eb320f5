"""The network as a graph: layers, cycles and connected components, in linear time and without recursion."""

from collections.abc import Iterable

from foon_asp.network.network import Network

UNREACHED = -1


def layers(network: Network, start: Iterable[int]) -> tuple[list[int], list[int]]:
    """Return two lists by id: the layer of each object node, and the layer of each unit.

    The nodes ``start`` are available and in layer 0. A unit is one layer above the highest of its inputs, and
    in layer 1 if it has none. Any other node is in the layer of the lowest unit that makes it. The layer of a
    node or unit that cannot be reached is ``UNREACHED``.
    """
    node_layer = [UNREACHED] * len(network.objects)
    unit_layer = [UNREACHED] * len(network)
    missing_inputs = [len(inputs) for inputs in network.inputs]
    frontier = list(dict.fromkeys(start))
    for node in frontier:
        node_layer[node] = 0
    ready = [unit for unit, inputs in enumerate(missing_inputs) if not inputs]
    layer = 0
    while frontier or ready:
        for node in frontier:
            for unit in network.consumers[node]:
                missing_inputs[unit] -= 1
                if not missing_inputs[unit]:
                    ready.append(unit)
        layer += 1
        frontier = []
        for unit in ready:
            unit_layer[unit] = layer
            for node in network.outputs[unit]:
                if node_layer[node] == UNREACHED:
                    node_layer[node] = layer
                    frontier.append(node)
        ready = []
    return node_layer, unit_layer


def cycles(network: Network) -> list[list[int]]:
    """Return the strongly connected components of object nodes that have a cycle, each as sorted ids.

    There is an edge from each input of a unit to each of its outputs. A node that is an input and an output
    of one unit is a cycle by itself.

    The algorithm is that of Tarjan (SIAM J. Comput. 1, 1972). Units are vertices too, which saves an edge for
    each pair of an input and an output.
    """
    size = len(network.objects)
    index = [0] * (size + len(network))  # 0: not met
    low = [0] * len(index)
    on_stack = bytearray(len(index))
    stack: list[int] = []
    components: list[list[int]] = []
    counter = 0
    for root in range(size):
        if index[root]:
            continue
        path = [(root, iter(network.consumers[root]))]
        counter += 1
        index[root] = low[root] = counter
        stack.append(root)
        on_stack[root] = 1
        while path:
            vertex, neighbours = path[-1]
            for neighbour in neighbours:
                target = neighbour + size if vertex < size else neighbour
                if not index[target]:
                    counter += 1
                    index[target] = low[target] = counter
                    stack.append(target)
                    on_stack[target] = 1
                    targets = network.consumers[target] if target < size else network.outputs[target - size]
                    path.append((target, iter(targets)))
                    break
                if on_stack[target]:
                    low[vertex] = min(low[vertex], index[target])
            else:
                path.pop()
                if path:
                    low[path[-1][0]] = min(low[path[-1][0]], low[vertex])
                if low[vertex] == index[vertex]:
                    component: list[int] = []
                    while True:
                        popped = stack.pop()
                        on_stack[popped] = 0
                        component.append(popped)
                        if popped == vertex:
                            break
                    if len(component) > 1:  # a node and a unit at least
                        components.append(sorted(node for node in component if node < size))
    return components


def component_sizes(network: Network) -> list[int]:
    """Return the number of units of each connected component, largest first, by union-find.

    Units are connected if they share an object node.
    """
    parent = list(range(len(network.objects)))

    def root(node: int) -> int:
        """Return the node that represents the component of a node, and shorten the path to it."""
        while parent[node] != node:
            parent[node] = parent[parent[node]]
            node = parent[node]
        return node

    nodes_by_unit = [
        (*inputs, *outputs) for inputs, outputs in zip(network.inputs, network.outputs, strict=True)
    ]
    for unit_nodes in nodes_by_unit:
        for node in unit_nodes[1:]:
            parent[root(node)] = root(unit_nodes[0])
    sizes: dict[int, int] = {}
    for unit_nodes in nodes_by_unit:
        root_node = root(unit_nodes[0])
        sizes[root_node] = sizes.get(root_node, 0) + 1
    return sorted(sizes.values(), reverse=True)
