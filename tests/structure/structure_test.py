#!/usr/bin/env python3
"""The checker against small trees that are wrong in one way each."""

import tempfile
import unittest
from pathlib import Path

import structure

GOOD = {
    "proto/haptic/v1/scene.proto": "",
    "daemon/engine/CMakeLists.txt": "haptic_library(haptic_engine\n  SOURCES\n    proxy.cpp)\n",
    "daemon/engine/proxy.h": "#pragma once\n#include <glm/vec3.hpp>\n#include <span>\n",
    "daemon/engine/proxy.cpp": '#include "engine/proxy.h"\n\n#include <cmath>\n',
    "daemon/servo/mailbox.h": '#pragma once\n#include <boost/lockfree/spsc_queue.hpp>\n#include "engine/proxy.h"\n',
    "daemon/servo/servo_loop.h": '#pragma once\n#include "drivers/device.h"\n#include "servo/mailbox.h"\n',
    "daemon/ipc/publisher.h": '#pragma once\n#include "haptic/v1/scene.pb.h"\n#include "servo/mailbox.h"\n',
    "drivers/device.h": "#pragma once\n#include <glm/vec3.hpp>\n",
    "drivers/simulated/simulated_device.h": '#pragma once\n#include "drivers/device.h"\n',
    "tests/fuzz/CMakeLists.txt": "haptic_fuzz(scene_fuzz DEPENDS haptic_load)\n",
    "tests/fuzz/scene_fuzz.cpp": '#include "engine/proxy.h"\n#include "haptic/v1/scene.pb.h"\n',
}


def problems_in(changes):
    """What the checker says of the good tree after `changes`: path -> text."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder) / "a tree"
        for path, text in {**GOOD, **changes}.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text, encoding="utf-8")
        return structure.check_tree(root)


class StructureTest(unittest.TestCase):
    def assert_only_problem(self, changes, path, line, part):
        problems = problems_in(changes)
        self.assertEqual([(path, line)], [problem[:2] for problem in problems], problems)
        self.assertIn(part, problems[0][2])

    def test_a_good_tree_has_no_problem(self):
        self.assertEqual([], problems_in({}))

    def test_an_empty_tree_is_a_problem(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual([(".", 1, "there is no source")], structure.check_tree(folder))

    def test_the_engine_includes_no_other_room(self):
        for header in ("servo/mailbox.h", "haptic/v1/scene.pb.h", "drivers/device.h"):
            with self.subTest(header):
                text = f'#pragma once\n#include "{header}"\n'
                self.assert_only_problem({"daemon/engine/world.h": text}, "daemon/engine/world.h", 2, "may not include")

    def test_no_source_is_included(self):
        text = '#include "engine/proxy.h"\n#include "engine/proxy.cpp"\n'
        lists = "haptic_library(haptic_engine SOURCES proxy.cpp world.cpp)\n"
        changes = {"daemon/engine/world.cpp": text, "daemon/engine/CMakeLists.txt": lists}
        self.assert_only_problem(changes, "daemon/engine/world.cpp", 2, "includes the source")

    def test_what_is_declared_by_using_is_used(self):
        begin = '#include "engine/proxy.h"\nusing glm::dvec3;  // dvec3\n'
        path = "daemon/engine/proxy.cpp"
        self.assert_only_problem({path: begin + 'const char* const name = "dvec3";\n'}, path, 2, "does not use dvec3")
        self.assertEqual([], problems_in({path: begin + "dvec3 origin;\n"}))

    def test_the_servo_sees_no_driver(self):
        text = '#pragma once\n#include "drivers/simulated/simulated_device.h"\n'
        self.assert_only_problem({"daemon/servo/set.h": text}, "daemon/servo/set.h", 2, "may not include")

    def test_ipc_sees_the_mailbox_but_not_the_loop(self):
        text = '#pragma once\n#include "servo/servo_loop.h"\n'
        self.assert_only_problem({"daemon/ipc/server.h": text}, "daemon/ipc/server.h", 2, "may not include")

    def test_the_device_interface_includes_nothing_of_ours(self):
        changes = {
            "daemon/rt/exchange.h": "#pragma once\n",
            "drivers/device.h": '#pragma once\n\n#include "rt/exchange.h"\n',
        }
        self.assert_only_problem(changes, "drivers/device.h", 3, "may not include")

    def test_only_the_registry_of_the_drivers_knows_the_schema(self):
        text = '#pragma once\n#include "haptic/v1/scene.pb.h"\n'
        self.assertEqual([], problems_in({"drivers/registry.h": text}))
        self.assert_only_problem({"drivers/playback/p.h": text}, "drivers/playback/p.h", 2, "may not include")

    def test_a_client_does_not_see_the_daemon(self):
        text = '#pragma once\n#include "engine/proxy.h"\n'
        self.assert_only_problem({"client/lib/c.h": text}, "client/lib/c.h", 2, "may not include")

    def test_main_may_include_anything_but_a_new_folder_needs_a_row(self):
        text = '#pragma once\n#include "servo/servo_loop.h"\n#include "drivers/device.h"\n'
        self.assertEqual([], problems_in({"daemon/run.h": text}))
        self.assert_only_problem({"daemon/extra/run.h": text}, "daemon/extra/run.h", 1, "table of rooms")

    def test_libraries_stay_in_their_rooms(self):
        for header in ("spdlog/spdlog.h", "google/protobuf/message.h", "boost/asio.hpp", "unistd.h"):
            with self.subTest(header):
                text = f"#pragma once\n#include <{header}>\n"
                self.assert_only_problem({"daemon/engine/a.h": text}, "daemon/engine/a.h", 2, "does not use")

    def test_a_tick_does_not_print_wait_or_ask_a_clock(self):
        for header in ("iostream", "thread", "mutex", "chrono"):
            with self.subTest(header):
                text = f"#pragma once\n#include <{header}>\n"
                self.assert_only_problem({"daemon/safety/a.h": text}, "daemon/safety/a.h", 2, "part of a tick")
        for code in ("std::cout << 1;", 'printf("x");', "free(p);", "thread_local int x;", "nanosleep (a, b);"):
            with self.subTest(code):
                text = f"#pragma once\ninline void f() {{\n  {code}\n}}\n"
                self.assert_only_problem({"daemon/servo/a.h": text}, "daemon/servo/a.h", 3, "part of a tick")

    def test_words_in_comments_strings_and_members_are_harmless(self):
        text = '#pragma once\n// std::cout, throw\n/* malloc(1) */\nconst char* s = "free(x) throw";\nint a = b.free(1);\n'
        self.assertEqual([], problems_in({"daemon/engine/a.h": text}))

    def test_only_what_builds_a_scene_throws(self):
        text = "#pragma once\ninline void f() { throw 1; }\n"
        self.assert_only_problem({"daemon/engine/world.h": text}, "daemon/engine/world.h", 2, "throw outside")
        self.assertEqual([], problems_in({"daemon/engine/shapes.h": text}))

    def test_only_what_builds_a_scene_composes_words(self):
        text = "#pragma once\n#include <sstream>\n"
        self.assert_only_problem({"daemon/engine/world.h": text}, "daemon/engine/world.h", 2, "part of a tick")
        self.assertEqual([], problems_in({"daemon/engine/shapes.h": text}))

    def test_a_source_includes_its_header_first(self):
        text = '#include <cmath>\n#include "engine/proxy.h"\n'
        self.assert_only_problem({"daemon/engine/proxy.cpp": text}, "daemon/engine/proxy.cpp", 1, "before anything")

    def test_a_header_has_a_guard(self):
        self.assert_only_problem({"daemon/rt/a.h": "int x;\n"}, "daemon/rt/a.h", 1, "#pragma once")

    def test_each_source_is_listed(self):
        self.assert_only_problem({"daemon/engine/box.cpp": ""}, "daemon/engine/box.cpp", 1, "CMakeLists.txt")
        commented = "haptic_library(haptic_engine SOURCES\n  # proxy.cpp\n  old_proxy.cpp)\n"
        changes = {"daemon/engine/CMakeLists.txt": commented}
        self.assert_only_problem(changes, "daemon/engine/proxy.cpp", 1, "CMakeLists.txt")
        self.assert_only_problem({"tests/fuzz/path_fuzz.cpp": ""}, "tests/fuzz/path_fuzz.cpp", 1, "CMakeLists.txt")

    def test_an_include_names_a_file_from_the_top(self):
        text = '#pragma once\n#include "engine/nowhere.h"\n'
        self.assert_only_problem({"daemon/engine/a.h": text}, "daemon/engine/a.h", 2, "no file of ours")
        text = '#pragma once\n#include "proxy.h"\n'
        self.assert_only_problem({"daemon/engine/a.h": text}, "daemon/engine/a.h", 2, "from the top")

    def test_a_message_without_schema_is_no_file(self):
        text = '#pragma once\n#include "haptic/v1/other.pb.h"\n'
        self.assert_only_problem({"daemon/ipc/a.h": text}, "daemon/ipc/a.h", 2, "no file of ours")

    def test_headers_do_not_include_each_other_in_a_circle(self):
        changes = {
            "daemon/engine/a.h": '#pragma once\n#include "engine/b.h"\n',
            "daemon/engine/b.h": '#pragma once\n#include "engine/a.h"\n',
        }
        self.assert_only_problem(changes, "daemon/engine/a.h", 1, "circle")

    def test_files_end_before_600_lines(self):
        self.assertEqual([], problems_in({"daemon/rt/a.h": "#pragma once\n" + "\n" * 599}))
        self.assert_only_problem({"daemon/rt/a.h": "#pragma once\n" + "\n" * 600}, "daemon/rt/a.h", 601, "600")

    def test_nothing_is_left_for_later(self):
        word = "TO" + "DO"
        text = f"#pragma once\n// {word}: finish\n"
        self.assert_only_problem({"daemon/rt/a.h": text}, "daemon/rt/a.h", 2, word)


if __name__ == "__main__":
    unittest.main()
