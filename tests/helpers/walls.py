"""An import contract: a room's files are imported by the room, everyone else asks its door."""

from importlinter import Contract, ContractCheck, fields, output


class Walls(Contract):
    """Whoever stands outside a room imports names from its ``__init__`` only."""

    packages = fields.ListField(subfield=fields.StringField())
    rooms = fields.ListField(subfield=fields.StringField(), required=False, default=[])

    def check(self, graph, verbose):
        """Find the imports of a room's files from outside."""
        rooms = [r for package in self.packages for r in graph.find_children(package)]
        rooms += self.rooms
        through = [
            (importer, file)
            for room in rooms
            for file in graph.find_descendants(room)
            for importer in graph.find_modules_that_directly_import(file)
            if importer != room and not importer.startswith(f"{room}.")
        ]
        return ContractCheck(kept=not through, metadata={"through": sorted(through)})

    def render_broken_contract(self, check):
        """Name them."""
        for importer, file in check.metadata["through"]:
            output.print_error(f"{importer} imports {file}: ask {file.rpartition('.')[0]}")
