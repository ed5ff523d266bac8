"""The API against its own document: whatever is asked, the answer is one that the document names."""

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, settings
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    negative_data_rejection,
    response_headers_conformance,
    response_schema_conformance,
    status_code_conformance,
)  # fmt: skip

from examples import examples
from unit.tms_ur.fakes import FakeSiteClient, app

schema = schemathesis.openapi.from_asgi("/openapi.json", app(FakeSiteClient()), headers={"Host": "localhost"})
BESIDE_THE_STREAM = schema.exclude(path="/api/events")  # it has no end
EXAMPLES = examples(15, 100)
CHECKS = [
    not_a_server_error, status_code_conformance, content_type_conformance, response_headers_conformance,
    response_schema_conformance, negative_data_rejection,
]  # fmt: skip


@pytest.mark.turns
@pytest.mark.timeout(300)
@BESIDE_THE_STREAM.parametrize()
@settings(
    max_examples=EXAMPLES, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True,
    phases=[Phase.explicit, Phase.generate],
)  # fmt: skip
def test_answers_are_as_documented(case: schemathesis.Case) -> None:
    response = case.call(headers={"Host": "localhost"})
    # A request that is too large is refused before anybody reads it.
    skipped = [negative_data_rejection] if response.status_code == 413 else []
    case.validate_response(response, checks=CHECKS, excluded_checks=skipped)
