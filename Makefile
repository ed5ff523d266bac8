# `make` lists the targets. Everything happens in .venv; nothing is installed outside this folder.
VENV ?= .venv
# The distribution's Python has priority where it is whole: it was built with profiles, as those of pyenv are not unless
# asked (1000 tasks are registered in three quarters of the time with it).
DISTRIBUTION := /usr/bin/python3
WHOLE := import ensurepip, os, sys, sysconfig, venv; \
  sys.exit(sys.version_info < (3, 10) or not os.path.exists(sysconfig.get_path("include") + "/Python.h"))
PYTHON ?= $(shell $(DISTRIBUTION) -c '$(WHOLE)' 2>/dev/null && echo $(DISTRIBUTION) || echo python3)
P ?=
SITE ?=
ROLE ?=
# Processes of `make test-fast` (three where nothing is said: some tests wait), of mutants and of the night.
WORKERS ?= auto
# Key under pcs: of the site file, where a PC is not named after its role, as the compose files are. (make knows a PC itself.)
PC = $(ROLE)
RUNTIME ?= native
# Debian's client has priority, since it builds without a plugin. Each use searches it, since `make containers` may have
# just installed it.
DOCKER ?= $(shell command -v /usr/bin/docker || echo docker)
# Debian's Compose is a program of its own; other distributions have a plugin of the client.
COMPOSE ?= $(if $(shell $(DOCKER) compose version 2>/dev/null),$(DOCKER) compose,docker-compose)
# The distribution that is built here: the next `make` must not undo `make interfaces NAV2_DISTRO=humble`.
NAV2_DISTRO ?= $(or $(patsubst .interfaces-%,%,$(notdir $(firstword $(wildcard $(VENV)/.interfaces-*)))),jazzy)
LOCKS := deploy/requirements
# The wheels of a bundle: nothing is asked of a registry then, and nothing is built.
BUNDLE := $(abspath $(wildcard wheels))
LOCK ?= $(if $(BUNDLE),requirements.lock,requirements-dev.lock)
ifneq ($(BUNDLE),)
export UV_FIND_LINKS=$(BUNDLE)
export PIP_NO_INDEX=1
export PIP_FIND_LINKS=$(BUNDLE)
endif
export UV_PACKAGE := uv==0.13.8
export NAV2_DISTRO
CONSOLE := services/tms_ur/console
BUILT := services/tms_ur/built/index.html
NPM = cd $(CONSOLE) && PATH="$(abspath $(VENV))-console/bin:$$PATH" npm --silent
UV := $(VENV)/bin/uv
INSTALL = $(UV) pip install -q $(if $(BUNDLE),--no-index)
PY := $(VENV)/bin/python
TMS := $(VENV)/bin/tms $(if $(SITE),--site $(SITE))
# A sourced ROS installation would mix its libraries into the venv's.
unexport PYTHONPATH LD_LIBRARY_PATH AMENT_PREFIX_PATH CMAKE_PREFIX_PATH _ROS_WHEELS_BOOTSTRAP_COMPLETE
.DEFAULT_GOAL := help
.PHONY: help setup ready console console-types bundle interfaces locks demo test test-fast up down status logs restart lint conformance bench verify pictures soak drill simulate areas replay model traces mutants mutmut coverage nightly test-docker fleet system containers clean

help: ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

setup: ## everything that the other targets need (they call it)
	@$(MAKE) --no-print-directory --jobs=3 ready
	@sh deploy/sockets.sh quiet
	@$(PY) -m compileall -q -j 0 -x 'services/interfaces' services $(wildcard tests)  # where Python itself may not write it, each process would compile anew

ready: $(VENV)/.ready $(if $(BUNDLE),$(if $(wildcard wheels/secantusdb-*),$(VENV)-store/.ready),$(VENV)-store/.ready $(BUILT))

system:
	@PYTHON=$(PYTHON) sh deploy/system-packages.sh $(if $(BUNDLE),python,setup)

$(UV): | system
	$(PYTHON) -m venv $(VENV)
	$(VENV)/bin/pip install -q --disable-pip-version-check $(UV_PACKAGE)

$(VENV)/.requirements: $(LOCKS)/requirements.lock $(LOCKS)/requirements-dev.lock | $(UV)
	$(INSTALL) --compile-bytecode -p $(PY) --require-hashes -r $(LOCKS)/$(LOCK)
	@touch $@

$(VENV)-store/.ready: $(LOCKS)/requirements-store.lock | $(UV)
	$(UV) venv -q --allow-existing -p $(PYTHON) $(VENV)-store
	$(INSTALL) --compile-bytecode -p $(VENV)-store/bin/python --require-hashes -r $(LOCKS)/requirements-store.lock
	@touch $@

# Node.js and the packages of the console have an environment of their own, and no script of a package runs. Node looks
# for packages in the folders above a source, so there is a link to them.
$(VENV)-console/.ready: $(LOCKS)/requirements-console.lock $(addprefix $(CONSOLE)/,package.json package-lock.json .npmrc) | $(UV)
	$(UV) venv -q --allow-existing -p $(PYTHON) $(VENV)-console
	$(INSTALL) -p $(VENV)-console/bin/python --require-hashes -r $(LOCKS)/requirements-console.lock
	cp $(filter $(CONSOLE)/%,$^) $(VENV)-console
	cd $(VENV)-console && PATH="$(abspath $(VENV))-console/bin:$$PATH" npm ci --silent
	@ln -sfn $(abspath $(VENV))-console/node_modules node_modules
	@touch $@

$(BUILT): $(VENV)-console/.ready $(shell find $(CONSOLE) -type f)
	$(NPM) run build

console: $(BUILT) ## build the pages of the console

console-types: setup ## the API's types for the console, after a change of the API
	@cd tests && $(abspath $(PY)) -m console_types

$(VENV)/interfaces/.$(NAV2_DISTRO): $(LOCKS)/build.lock $(shell find services/interfaces -type f -not -name '*.pyc') | $(UV)
	@rm -rf $(VENV)/interfaces
	@echo "building the ROS interface packages (one to two minutes)"
	$(UV) build -q -p $(PY) --wheel --build-constraints $(LOCKS)/build.lock -o $(VENV)/interfaces services/interfaces
	@touch $@

$(VENV)/.interfaces-$(NAV2_DISTRO): $(VENV)/.requirements $(if $(BUNDLE),,$(VENV)/interfaces/.$(NAV2_DISTRO))
	$(INSTALL) --compile-bytecode -p $(PY) --no-deps --reinstall $(or $(BUNDLE),$(VENV)/interfaces)/tms_interfaces-*.whl
	$(PY) services/interfaces/_wheel/stubs.py
	@rm -f $(VENV)/.interfaces-*
	@touch $@

$(VENV)/.ready: $(VENV)/.interfaces-$(NAV2_DISTRO) pyproject.toml
	$(INSTALL) -p $(PY) --no-deps --build-constraints $(LOCKS)/build.lock -e .
	@touch $@

# uv keeps the versions that are in a lock already.
COMPILE = $(UV) --directory $(LOCKS) pip compile -q --universal --python-version 3.10 --custom-compile-command "make locks" \
  $(addprefix --upgrade-package=,$(UPGRADE))
locks: | $(UV) ## lock the requirements of deploy/requirements/*.in anew (UPGRADE="name other": newest of these)
	$(COMPILE) --generate-hashes requirements.in -o requirements.lock
	$(COMPILE) --generate-hashes requirements-dev.in -o requirements-dev.lock
	$(COMPILE) --generate-hashes requirements-store.in -o requirements-store.lock
	$(COMPILE) --generate-hashes requirements-console.in -o requirements-console.lock
	$(COMPILE) build.in -o build.lock

bundle: setup ## one file for PCs without internet, where it needs only `make setup` (OUT=dist; STORE=1: with the embedded store; IMAGE=ros2-tms)
	@$(if $(BUNDLE),echo "this is a bundle: make it where the project comes from" >&2; exit 2,DOCKER=$(DOCKER) STORE="$(STORE)" IMAGE="$(IMAGE)" sh deploy/bundle.sh $(VENV) $(or $(OUT),dist))

interfaces: $(VENV)/.interfaces-$(NAV2_DISTRO) ## build the .msg/.srv/.action packages (NAV2_DISTRO=humble for Humble machines)

demo: setup ## an excavator loads a truck, which hauls: set-up, mesh, task, SUCCESS; leaves the mesh running
	@$(TMS) demo

ifeq ($(RUNTIME),docker)
COMPOSE_UP = TMS_SITE_NAME=$(SITE) TMS_PC=$(PC) $(COMPOSE) -p tms-$(PC) -f deploy/compose/$(ROLE).yml
ROLES := $(filter-out base,$(patsubst deploy/compose/%.yml,%,$(wildcard deploy/compose/*.yml)))
up: ## start the mesh of this PC (SITE=name, ROLE=PC of a site with several, RUNTIME=docker)
	@test -n "$(SITE)" -a -n "$(filter $(ROLES),$(ROLE))" || { echo "usage: make up SITE=yard ROLE=cps RUNTIME=docker (roles: $(ROLES); a PC with another name: PC=truck_pc ROLE=machine)" >&2; exit 2; }
	@test -n "$(TMS_IMAGE)" || DOCKER=$(DOCKER) sh deploy/image.sh $(if $(filter trial,$(ROLE)),ros2-tms-trial demo,ros2-tms)
	@sh deploy/sockets.sh
	@$(COMPOSE_UP) up --detach
down: ## end the mesh of this PC; no process stays
	@$(COMPOSE_UP) down
else
up: setup ## start the mesh of this PC (SITE=name, ROLE=PC of a site with several, RUNTIME=docker)
	@sh deploy/sockets.sh
	@$(TMS) up $(if $(PC),--role $(PC))

down: ## end the mesh of this PC; no process stays
	@test -x $(VENV)/bin/tms || { echo "nothing is set up here, so nothing runs"; exit 0; }; $(TMS) down
endif

status: setup ## does everything work?
	@$(TMS) status

logs: setup ## last log lines (P=name)
	@$(TMS) logs $(P)

restart: setup ## restart one process (P=name)
	@test -n "$(P)" || { echo "usage: make restart P=zx200:rc (make status lists the names)" >&2; exit 2; }
	@$(TMS) restart $(P)

# pytest keeps the assertions that it has rewritten: its next start takes half as long
test test-fast: export PYTHONDONTWRITEBYTECODE :=

test: setup ## tests that a laptop can run; long ones come once a week (TURN=1 to 7, or all)
	@DOCKER=$(DOCKER) sh deploy/system-packages.sh test
	@$(NPM) test
	$(PY) -m pytest --turn=$(or $(TURN),today) -n 3 --dist loadfile --no-loadscope-reorder tests || { \
	  echo "again, alone: what passes now was disturbed by other tests on this PC, or is not reliable: both are told"; \
	  $(PY) -m pytest --last-failed --last-failed-no-failures none -rp tests; }

test-fast: setup ## unit, contract and conformance tests without long ones: no ROS processes, two minutes (WORKERS=3)
	@DOCKER=$(DOCKER) sh deploy/system-packages.sh test
	@$(NPM) test
	$(PY) -m pytest -q --hypothesis-profile=fast -m "not turns" -n $(patsubst auto,3,$(WORKERS)) tests/unit tests/contract tests/conformance

lint: setup ## ruff, mypy, import-linter; Biome and tsc
	@$(NPM) run lint
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/mypy services
	MYPYPATH=tests $(VENV)/bin/mypy tests/operasim
	MYPYPATH=tests $(VENV)/bin/mypy tests/simulation  # make simulate compiles it
	cd services && ../$(VENV)/bin/lint-imports --config ../pyproject.toml

conformance: setup ## replay behaviour-tree cases (CASES=path LEVEL=required|strict)
	@$(PY) tests/conformance/replay_cases.py "$(or $(CASES),tests/conformance/cases.jsonl)" --level "$(or $(LEVEL),required)"

drill: setup ## stop six simulated machines in every way; receipts against the truth (QUICK=1, ROUNDS=4, SEED=7, REPORT=file.md, ONLY="kill rc+tms:ts"; SITE=drill-physx: over OperaSim)
	@$(VENV)/bin/tms --site $(or $(SITE),drill) drill $(if $(QUICK),--quick) $(if $(ROUNDS),--rounds $(ROUNDS)) $(if $(SEED),--seed $(SEED)) $(if $(LEDGER),--ledger $(LEDGER)) $(if $(ONLY),--only "$(ONLY)") $(if $(REPORT),--report $(REPORT))

simulate: setup ## a site in virtual time goes wrong thousands of times; invariants against the true motion; areas, people and places first (SCHEDULES=15000 SEED=7)
	@$(MAKE) --no-print-directory areas HISTORIES=$$(( $(or $(SCHEDULES),15000) / 100 + 1 ))
	@where=$$(cd tests && $(abspath $(PY)) -m simulation.compiled $(abspath $(VENV))/simulation $(if $(SCHEDULES),--schedules $(SCHEDULES))) && \
	  cd "$$where" && PYTHONPATH=$(abspath tests) $(abspath $(PY)) -m simulation.run $(if $(SCHEDULES),--schedules $(SCHEDULES)) $(if $(SEED),--seed $(SEED)) $(if $(LEDGER),--ledger $(abspath $(LEDGER)))

areas: setup ## machines between areas in virtual time: nobody crosses a border, few stops are needless (HISTORIES=10000 SEED=7)
	@cd tests && PYTHONPATH=. $(abspath $(PY)) -m areas.run $(if $(HISTORIES),--histories $(HISTORIES)) $(if $(SEED),--seed $(SEED))

model: setup ## stop, permit, fence and latch in all their states (ONLY=check; DEFECTS=1: each planted defect must be found)
	@sh deploy/system-packages.sh spin
	@cd tests && $(abspath $(PY)) -m model.run $(if $(DEFECTS),--defects) $(if $(ONLY),--only "$(ONLY)")

traces: setup ## the trials of the last drill are histories of that model (STATE=folder of its state)
	@sh deploy/system-packages.sh spin
	@cd tests && $(abspath $(PY)) -m model.journals $(abspath $(or $(STATE),.state/drill/drill))

mutants: setup ## defects planted in the decisions one at a time; the simulation must find each (SLICE=20 ONLY=name SCHEDULES=5000 TURN=3 LIST=1)
	@cd tests && $(abspath $(PY)) -m mutants.run $(if $(ONLY),--only $(ONLY)) $(if $(SLICE),--slice $(SLICE)) $(if $(TURN),--turn $(TURN)) $(if $(SCHEDULES),--schedules $(SCHEDULES)) $(if $(LEDGER),--ledger $(LEDGER)) $(if $(filter-out auto,$(WORKERS)),--workers $(WORKERS)) $(if $(LIST),--list)

mutmut: setup ## hundreds of small changes of proof and latch; the unit tests must fail for 9 of 10, and the others be judged
	@cd tests && $(abspath $(PY)) -m mutants.mutmut_run $(abspath $(VENV))/mutmut $(if $(filter-out auto,$(WORKERS)),--workers $(WORKERS))

replay: setup ## simulated plans on real processes, as root: both tell the same history (ONLY="gateway and killed": words of their names; TURN=today: a seventh of them)
	@DOCKER=$(DOCKER) sh deploy/system-packages.sh test
	TMS_REPLAY=1 $(PY) -m pytest -p no:randomly tests/replay/test_replay.py $(if $(TURN),--turn $(TURN)) $(if $(ONLY),-k "$(ONLY)")

coverage: setup ## unit tests take every branch of the decisions and proofs
	$(PY) -m coverage run --data-file=$(VENV)/coverage --branch --source tms_decision,tms_proof -m pytest -q tests/unit/tms_decision tests/unit/tms_proof tests/unit/tms_ts/test_interrupted.py
	$(PY) -m coverage report --data-file=$(VENV)/coverage --show-missing --skip-covered --fail-under=100

nightly: setup ## what takes hours: all tests, also of containers, properties with 400 examples, 100,000 schedules, all mutants, mutmut, replays and 30 power cuts (as root), 60 m3 of earth with kills, 50 rounds of two trucks and a road, a long drill
	@$(MAKE) test TURN=all
	@$(MAKE) test-docker
	$(PY) -m pytest -q -n $(WORKERS) --hypothesis-profile=thorough tests/unit tests/fuzz
	@$(MAKE) coverage
	@$(MAKE) simulate SCHEDULES=100000
	@$(MAKE) areas
	TMS_AREA_HISTORIES=30 $(PY) -m pytest tests/ros/test_areas.py
	@$(MAKE) mutants
	@$(MAKE) mutmut
	TMS_POWER_CUTS=30 $(PY) -m pytest tests/system/test_power_cut.py
	TMS_EARTH=60 $(PY) -m pytest tests/system/test_earthwork.py tests/system/test_dig_speed.py -k "killed or speed"
	TMS_ROUNDS=50 $(PY) -m pytest tests/system/test_shared_places.py -k turns
	@$(MAKE) replay
	@$(MAKE) drill ROUNDS=4
	@$(MAKE) drill SITE=drill-physx ROUNDS=2

bench: setup ## benchmarks with ratios to a floor of the same run (ONLY=group)
	@sh deploy/system-packages.sh chromium
	@$(PY) tests/bench $(if $(ONLY),--only "$(ONLY)")

verify: setup ## the verification run of the paper over a stand-in of OperaSim-PhysX: 13 requirements, measured; kept in .state/verification/
	@sh deploy/system-packages.sh chromium
	@cd tests && $(abspath $(PY)) -m verify

pictures: setup ## state machines in ARCHITECTURE.md; each page of the running demo's console (it runs its task once more)
	@cd tests && $(abspath $(PY)) -m simulation.transitions
	@sh deploy/system-packages.sh chromium japanese
	@$(if $(SITE),TMS_SITE="$(SITE)") $(PY) tests/pictures.py

soak: setup ## two trucks and an excavator move earth while processes are killed; nothing may grow, or be told wrongly (MINUTES=120)
	@$(PY) tests/soak $(if $(MINUTES),--minutes "$(MINUTES)")

containers: ## the system packages of test-docker: a Docker engine, Compose and more
	@DOCKER=$(DOCKER) sh deploy/system-packages.sh containers

test-docker: setup containers ## a site of four PCs as containers; starts a Docker engine where none runs (TURN=today: without what comes on other days)
	@DOCKER=$(DOCKER) $(PY) -m pytest -p no:randomly -m docker -s --durations=0 $(if $(TURN),--turn $(TURN)) tests/docker

fleet: setup containers ## how many machines four PCs carry, each with a scheduler: containers on this PC (MACHINES="40 60")
	@TMS_FLEET="$(or $(MACHINES),40 60)" DOCKER=$(DOCKER) $(PY) -m pytest -p no:randomly -m docker -s tests/docker/test_fleet.py

clean: down ## remove the environments and the demo's state (SITE=name: that site's)
	rm -rf $(VENV) $(VENV)-store $(VENV)-console node_modules $(dir $(BUILT)) .state/$(basename $(notdir $(or $(SITE),demo)))
