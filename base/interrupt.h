#pragma once

namespace pendular {

/// From here on Ctrl-C (SIGINT) and SIGTERM ask the running work to stop instead of killing the program.
void catch_interrupts();

/// The same by whoever calls it, also from a signal handler; and taking it back, once what worked has
/// stopped.
void ask_to_stop();
void go_on();

/// True once the user has asked to stop.
bool interrupted();

/// Throws Interrupted once the user has asked to stop; long loops call it at least every half second.
void stop_if_interrupted();

}  // namespace pendular
