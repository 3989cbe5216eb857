"""What measurements do not tell, or a model does not take."""


class MasterRefused(Exception):
    """It says what to do."""


def document_of(thing):
    try:
        return thing.Document
    except ReferenceError as gone:
        raise MasterRefused("the object is not there any more: it was deleted, or its document was closed; take the one of the open document") from gone
