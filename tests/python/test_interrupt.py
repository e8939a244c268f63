"""Ctrl-C and a callback that throws keep a checkpoint, from which a run goes on to the same bytes."""

import os
import signal
import threading
import unittest

import pendular
from support import InScratchFolder


class Stop(Exception):
    pass


class Interrupt(InScratchFolder):
    def compress(self, name, **how):
        return pendular.compress(pendular.generate(self.sample), self.sample, self.folder / name, **how)

    def check_goes_on(self):
        self.assertTrue((self.folder / "run" / "checkpoint").exists())
        self.assertFalse((self.folder / "run" / "result.json").exists())
        self.compress("run", resume=True)
        self.compress("whole")
        for name in ("curve.csv", "events.csv"):
            self.assertEqual((self.folder / "run" / name).read_bytes(), (self.folder / "whole" / name).read_bytes())

    def test_keyboard_interrupt_leaves_a_checkpoint(self):
        with self.assertRaisesRegex(KeyboardInterrupt, "interrupted at strain"):
            self.compress("run", progress=lambda *_: os.kill(os.getpid(), signal.SIGINT))
        self.check_goes_on()

    def test_an_exception_of_the_callback_leaves_a_checkpoint(self):
        def stop(what, done, note):
            raise Stop("enough")

        with self.assertRaisesRegex(Stop, "enough"):
            self.compress("run", progress=stop)
        self.check_goes_on()

    def test_a_handler_of_the_user_is_asked_what_it_means(self):
        def refuse(signum, frame):
            raise Stop("by the handler")

        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, refuse))
        with self.assertRaisesRegex(Stop, "by the handler"):
            self.compress("run", progress=lambda *_: os.kill(os.getpid(), signal.SIGINT))
        self.assertIs(signal.getsignal(signal.SIGINT), refuse)
        self.check_goes_on()

    def test_another_thread_runs_meanwhile(self):
        told, seen = threading.Event(), []
        other = threading.Thread(target=lambda: seen.append(told.wait(60)))
        other.start()
        self.compress("run", progress=lambda *_: told.set())
        other.join()
        self.assertEqual(seen, [True])


if __name__ == "__main__":
    unittest.main()
