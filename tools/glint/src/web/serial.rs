//! The live page of a board on a serial port: its console, transfers and pictures on request.

use crate::board::SerialBoard;
use glint_live_page::Live;

impl Live for SerialBoard {}
