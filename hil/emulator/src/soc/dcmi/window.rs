//! The crop window (RM0090 §15.5.5, §15.8.8, §15.8.9).

/// DCMI_CWSTRT and DCMI_CWSIZE.
#[derive(Clone, Copy, Debug, Default)]
pub struct Window {
    /// HOFFCNT: pixel clocks before the window; VST: lines before it.
    pub start: u32,
    /// CAPCNT and VLINE: pixel clocks and lines of the window, less one.
    pub size: u32,
}

impl Window {
    fn first_line(self) -> u32 {
        self.start >> 16 & 0x1fff
    }

    fn last_line(self) -> u32 {
        self.first_line() + (self.size >> 16 & 0x3fff)
    }

    /// The part of line `number` (from 0) inside the window. One byte is one pixel clock.
    pub fn of_line(self, number: u32, bytes: &[u8]) -> &[u8] {
        if !(self.first_line()..=self.last_line()).contains(&number) {
            return &[];
        }
        let begin = ((self.start & 0x3fff) as usize).min(bytes.len());
        let len = (self.size & 0x3fff) as usize + 1;
        let end = (begin + len).min(bytes.len());
        &bytes[begin..end]
    }

    /// True if line `number` is the last one of the window.
    pub fn ends_with(self, number: u32) -> bool {
        number == self.last_line()
    }
}
