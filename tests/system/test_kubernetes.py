"""Goal: what abut writes for Kubernetes is what the API takes, each part gets what it needs and no
more, and the commands of the pods run the scene to the bits of one process.

No cluster: Kustomize (kubectl) puts the files together, the models of Python's kubernetes say what
the API takes, and the commands of all pods run on this machine, with folders in place of volumes
and 127.0.0.1 in place of the service's name.
usage: test_kubernetes.py ABUT ROOT      exit code 77 (skipped) without kubectl or kubernetes
"""

import base64
import re
import shutil
import subprocess
import sys
from pathlib import Path

import yaml
from support import ABUT, ROOT, SystemTest, free_port, main

try:
    from kubernetes import client
except ImportError:
    client = None

SCENE = ROOT / "configs" / "two_bars.yaml"
KINDS = {"Job": "V1Job", "Service": "V1Service", "ConfigMap": "V1ConfigMap", "Secret": "V1Secret"}


def strict(kind: str, value: object, path: str):
    """Raises ValueError of a field that the API does not know, misses, or has of another type."""
    if match := re.fullmatch(r"list\[(.+)\]", kind):
        if not isinstance(value, list):
            raise ValueError(f"{path} is no list")
        return [strict(match[1], item, f"{path}[{i}]") for i, item in enumerate(value)]
    if match := re.fullmatch(r"dict\(str, (.+)\)", kind):
        return {key: strict(match[1], item, f"{path}.{key}") for key, item in value.items()}
    plain = {"str": str, "int": int, "bool": bool, "object": object}.get(kind)
    if plain is not None:
        if not isinstance(value, plain) or (plain is int and isinstance(value, bool)):
            raise ValueError(f"{path} is no {kind}: {value!r}")
        return value
    model = getattr(client, kind)
    names = {wire: name for name, wire in model.attribute_map.items()}
    if not isinstance(value, dict):
        raise ValueError(f"{path} is no {kind}")
    if unknown := set(value) - set(names):
        raise ValueError(f"{path} has fields that {kind} has not: {unknown}")
    return model(**{names[key]: strict(model.openapi_types[names[key]], item, f"{path}.{key}")
                    for key, item in value.items()})  # which raises where one is missing


class KubernetesTest(SystemTest):
    def base(self, scene: Path, *arguments: object) -> Path:
        folder = self.folder / "base"
        said = self.succeed(self.abut("kubernetes", scene, "-o", folder, *arguments)).stdout
        command = re.search(r"next: abut (keygen .*) && kubectl apply -k (.*)\n", said)
        self.assertEqual(command[2], str(folder))
        self.succeed(self.abut(*command[1].split()))
        return folder

    def resources(self, folder: Path) -> list:
        said = subprocess.run(["kubectl", "kustomize", folder], capture_output=True, text=True,
                              check=False)
        self.assertEqual(said.returncode, 0, said.stderr)
        return list(yaml.safe_load_all(said.stdout))

    def of_kind(self, resources: list, kind: str) -> dict:
        return {each["metadata"]["name"]: each for each in resources if each["kind"] == kind}


class Files(KubernetesTest):
    def check_all(self, resources: list, processes: int):
        for each in resources:
            strict(KINDS[each["kind"]], each, each["kind"])
        jobs = self.of_kind(resources, "Job")
        self.assertEqual(len(jobs), processes + 1)
        secrets, scenes = (self.of_kind(resources, kind) for kind in ("Secret", "ConfigMap"))
        (service,) = self.of_kind(resources, "Service").values()
        self.assertEqual(service["spec"]["clusterIP"], "None")
        chosen = [job for job in jobs.values()
                  if service["spec"]["selector"].items()
                  <= job["spec"]["template"]["metadata"]["labels"].items()]
        self.assertEqual(len(chosen), 1, "one pod has the service's name")
        self.assertIn("--await", chosen[0]["spec"]["template"]["spec"]["containers"][0]["command"])
        for name, job in jobs.items():
            self.assertRegex(name, r"^[a-z0-9]([a-z0-9-]{0,61}[a-z0-9])?$")
            pod = job["spec"]["template"]["spec"]
            self.assertEqual(pod["restartPolicy"], "Never")
            self.assertTrue(pod["securityContext"]["runAsNonRoot"])
            self.assertFalse(pod["automountServiceAccountToken"])
            volumes = {volume["name"]: volume for volume in pod["volumes"]}
            for container in pod["containers"] + pod["initContainers"]:
                self.assertTrue(container["securityContext"]["readOnlyRootFilesystem"])
                self.assertEqual(container["securityContext"]["capabilities"]["drop"], ["ALL"])
                for mount in container["volumeMounts"]:
                    self.assertIn(mount["name"], volumes)
            self.assertIn(volumes["scene"]["configMap"]["name"], scenes)
            held = set(secrets[volumes["secret"]["secret"]["secretName"]]["data"])
            hidden = {key for key in held if key.endswith("_secret")}
            self.assertEqual(len(hidden), 1, "its own secret key and no other")
            if job is not chosen[0]:
                command = pod["containers"][0]["command"]
                address = command[command.index("--connect") + 1]
                self.assertEqual(address, f"tcp://{service['metadata']['name']}:5555")
                self.assertEqual(held - hidden, {"coordinator.key"})

    def test_a_job_for_each_process(self):
        self.check_all(self.resources(self.base(SCENE)), 2)

    def test_processes_of_several_bodies_and_meshes(self):
        scene = ROOT / "configs" / "contact" / "balls_100.yaml"
        resources = self.resources(self.base(scene, "--set", "network.processes=4"))
        self.check_all(resources, 4)

    def test_cpus_image_and_claim(self):
        scene = ROOT / "configs" / "solids" / "torsion_column.yaml"
        resources = self.resources(self.base(
            scene, "--set", "bodies.column.model.fe.threads=3", "--image", "registry/abut:1",
            "--claim", "runs"))
        self.check_all(resources, 1)
        pods = {name: job["spec"]["template"]["spec"]
                for name, job in self.of_kind(resources, "Job").items()}
        (body,) = [pod for name, pod in pods.items() if not name.endswith("coordinator")]
        self.assertEqual(body["containers"][0]["resources"]["requests"]["cpu"], "3")
        (coordinator,) = [pod for name, pod in pods.items() if name.endswith("coordinator")]
        self.assertIn({"name": "runs", "persistentVolumeClaim": {"claimName": "runs"}},
                      coordinator["volumes"])
        for pod in pods.values():
            self.assertEqual(pod["containers"][0]["image"], "registry/abut:1")

    def test_names_that_the_api_does_not_take_are_changed(self):
        scene = self.folder / "Zwei Stäbe_1.yaml"
        text = SCENE.read_text(encoding="utf-8").replace("left", "Left_Bar")
        scene.write_text(text, encoding="utf-8")
        self.check_all(self.resources(self.base(scene)), 2)

    def test_lost_bodies_are_tried_again_where_the_scene_says_so(self):
        resources = self.resources(self.base(
            SCENE, "--set", "network.on_lost_body=restart", "--set",
            "output.checkpoint={windows: 100}"))
        self.check_all(resources, 2)
        retries = {job["metadata"]["name"]: job["spec"]["backoffLimit"]
                   for job in resources if job["kind"] == "Job"}
        self.assertEqual(retries, {"two-bars-coordinator": 0, "two-bars-left": 6,
                                   "two-bars-right": 6})

    def test_what_the_image_must_hold_is_said(self):
        scene = ROOT / "examples" / "python_body" / "bar_meets_mass.yaml"
        launch = "bodies.mass.launch={spawn: {program: %s}}"
        for program, words in (("./py/ball.py", f'"{self.folder}/py/ball.py": none'),
                               ("ball", '"ball" on its PATH: none')):
            folder = self.folder / program.replace("/", "")
            said = self.succeed(self.abut("kubernetes", scene, "-o", folder, "--set",
                                          launch % program, "--set", "network=null")).stdout
            need = f"The image must hold the program of mass, {words} is taken along from here."
            self.assertIn(f"\nnote: {need}", said)
            self.assertIn(f"\n# {need}", (folder / "kustomization.yaml").read_text("utf-8"))
        (first,) = [job for job in yaml.safe_load_all(
            (self.folder / "." / ".pyball.py" / "bodies.yaml").read_text("utf-8"))
            if job["metadata"]["name"].endswith("mass")]
        self.assertEqual(first["spec"]["template"]["spec"]["containers"][0]["command"][0],
                         f"{self.folder}/py/ball.py")
        self.assertNotIn("image must", self.succeed(
            self.abut("kubernetes", SCENE, "-o", self.folder / "ours")).stdout)

    def test_what_cannot_be_is_refused(self):
        stages = self.abut("kubernetes", ROOT / "configs" / "contact" / "preload_then_impact.yaml")
        self.assertEqual(stages.returncode, 2)
        self.assertIn("stages: begin with new processes", stages.stderr)
        folder = self.folder / "base"
        self.base(SCENE)
        again = self.abut("kubernetes", SCENE, "-o", folder)
        self.assertEqual(again.returncode, 2)
        self.assertIn("is there already", again.stderr)
        scene = self.folder / "named.yaml"
        scene.write_text(SCENE.read_text(encoding="utf-8").replace("left", "coordinator"),
                         encoding="utf-8")
        named = self.abut("kubernetes", scene)
        self.assertEqual(named.returncode, 2)
        self.assertIn("bodies.coordinator: has a name that no file of keys can have", named.stderr)


class Pods(KubernetesTest):
    """Every command of a pod runs here, as the pod would run it."""

    def rehearse(self, scene: Path, *arguments: object) -> dict:
        resources = self.resources(self.base(scene, *arguments))
        secrets, scenes = (self.of_kind(resources, kind) for kind in ("Secret", "ConfigMap"))
        port = free_port()
        running = []
        for name, job in self.of_kind(resources, "Job").items():
            pod = job["spec"]["template"]["spec"]
            volumes = {volume["name"]: volume for volume in pod["volumes"]}
            place = self.folder / name
            files = {"secret": secrets[volumes["secret"]["secret"]["secretName"]]["data"],
                     "scene": scenes[volumes["scene"]["configMap"]["name"]].get("data", {})}
            for volume in ("secret", "scene", "keys"):
                (place / volume).mkdir(parents=True)
            for key, value in files["secret"].items():
                (place / "secret" / key).write_bytes(base64.b64decode(value))
            for key, value in files["scene"].items():
                (place / "scene" / key).write_text(value, encoding="utf-8")

            def here(word: str, place: Path = place) -> str:
                for inside in ("/secret/", "/keys/", "/scene/"):
                    word = word.replace(inside, f"{place}{inside}")
                word = word.replace("/abut/runs/", f"{self.folder}/runs/")
                return re.sub(r"tcp://(0\.0\.0\.0|[a-z0-9-]+):5555",
                              f"tcp://127.0.0.1:{port}", word)
            for container in pod["initContainers"]:
                self.succeed(self.end(self.start(*map(here, container["command"]))))
            program, *words = map(here, pod["containers"][0]["command"])
            running.append(self.start(ABUT.with_name(program), *words))
        for process in running:
            self.succeed(self.end(process))
        (run,) = (self.folder / "runs").iterdir()
        return self.summary(run)

    def assert_same(self, scene: Path, *arguments: object):
        far = self.rehearse(scene, *arguments)
        self.succeed(self.abut("run", scene, "--local", "--out", self.out, *arguments))
        for key in ("state_hash", "measures", "exchanges"):
            self.assertEqual(far[key], self.summary()[key], key)

    def test_two_bars(self):
        self.assert_same(SCENE)

    def test_a_process_of_two_bodies(self):
        self.assert_same(SCENE, "--set", "network.processes=1")

    def test_a_mesh_is_taken_along(self):
        self.assert_same(ROOT / "configs" / "solids" / "gmsh_part.yaml")


if __name__ == "__main__":
    if client is None:
        print("skipped: Python's kubernetes is not installed (Debian: python3-kubernetes)")
        sys.exit(77)
    if shutil.which("kubectl") is None:
        print("skipped: there is no kubectl")
        sys.exit(77)
    main()
