<ColorCorrection id="warm">
    <SOPNode>
        <Slope>1.02 1.0 0.97</Slope>
        <Offset>0.0 0.0 0.0</Offset>
        <Power>1.0 1.0 1.0</Power>
    </SOPNode>
    <SatNode>
        <Saturation>1.05</Saturation>
    </SatNode>
</ColorCorrection>
