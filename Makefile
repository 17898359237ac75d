# hydra_actuator: `make demo` runs the main job, `make test` the tests. Both make their own .venv.

PYTHON ?= python3
BIN := .venv/bin

# .venv holds a ROS 2 of its own. What a sourced /opt/ros or another such environment puts before
# it would mix two of them; the last is the mark by which the ROS wheels know that they have
# already put their libraries on LD_LIBRARY_PATH.
unexport PYTHONPATH PYTHONHOME AMENT_PREFIX_PATH LD_LIBRARY_PATH _ROS_WHEELS_BOOTSTRAP_COMPLETE

.PHONY: demo test soak bench growth peers study picture tables venv clean

demo: venv
	$(BIN)/hydra_actuator demo

# Two at a time what waits for nobody; one after the other what keeps time.
test: venv
	$(BIN)/ruff check .
	$(BIN)/python -m pytest -q -n 2 --dist worksteal --ignore test/ros test
	$(BIN)/python -m pytest -q test/ros examples

# The long tests: minutes each, on a machine that does nothing else.
soak: venv
	$(BIN)/python -m pytest -m soak

# Speed, and whether a step has become slower against a bare loop than docs/speed.jsonl has it.
bench: venv
	$(BIN)/hydra_actuator bench
	$(BIN)/hydra_actuator bench --guard docs/speed.jsonl

# The design study: 256 runs and their picture, see docs/design_study.md.
study: venv
	$(BIN)/hydra_actuator sweep --config examples/design_study/base.yaml \
	  --vary cylinder.area_1+cylinder.area_2=5e-4:3e-3:log \
	  --vary valve.area_gradient=0.01:0.1:log --vary line_1.length+line_2.length=0.02:0.6:log \
	  --samples 256 --sine 100 --duration 0.15 --from 0.1 -o build/study
	$(BIN)/hydra_actuator report build/study -o build/study.html
	$(BIN)/python examples/design_study/draw.py build/study docs/design_study.png

# How cost grows, see docs/growth.md; and other solvers on one line.
growth: venv
	$(BIN)/hydra_actuator bench --growth docs/growth.png

peers: venv
	$(BIN)/hydra_actuator bench --peers

# The README's picture.
picture: venv
	rm -rf build/picture
	$(BIN)/hydra_actuator simulate --config docs/picture.yaml --sine 50 --duration 0.4 --rate 10000 \
	  -o build/picture
	$(BIN)/python -c "from hydra_actuator.analysis.picture import write_picture; \
	  write_picture('build/picture', 'docs/run.png')"

# The tables of parameters and of cases, in the README and docs/verify.md.
tables: venv
	$(BIN)/python -m hydra_actuator.parameters.markdown README.md
	$(BIN)/python -m hydra_actuator.verification.markdown README.md docs/verify.md

venv: .venv/installed

# Made afresh when what it is made of changes. --use-pep517 because an old pip would otherwise obey
# setup.cfg, which puts the commands where `ros2 run` looks, not into bin/.
.venv/installed: setup.py setup.cfg constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))' 2>/dev/null || \
	  { echo 'make: $(PYTHON) is not Python 3.11 to 3.13; try make PYTHON=python3.12' >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || \
	  { echo 'make: $(PYTHON) cannot make environments: apt install python3-venv' >&2; exit 1; }
	@echo 'make: installing ROS 2 and all else into .venv, a minute or two'
	@rm -rf .venv
	@$(PYTHON) -m venv .venv
	@$(BIN)/python -m pip install --quiet --use-pep517 -c constraints.txt -e '.[test,ros,report,response,export,sweep]'
	@touch $@

clean:
	rm -rf .venv .pytest_cache .ruff_cache .hypothesis build dist install log *.egg-info
	find hydra_actuator test launch -name __pycache__ -type d -exec rm -rf {} +
